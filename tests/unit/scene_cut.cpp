// cut(): surfaces of which textures say where they are and where they shine.
#include "cut.hpp"

#include <gmock/gmock.h>

#include "lichtveld/scene/lights.hpp"
#include "scene_builder.hpp"
#include "scene_log.hpp"

namespace lichtveld::scene {
namespace {

using testing::LogCapture;
using testing::SceneBuilder;
using testing::TempFolder;

// 2 x 1 m in the plane z = 0, with texture coordinates from 0 to 1.
struct Sheet {
  Sheet() {
    for (const glm::vec2 at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)})
      vertices.push_back({{2 * at.x, at.y, 0}, {0, 0, 1}, at, at, 0});
  }

  std::vector<Cut> cut_by(const Uneven& uneven, int times = 5) {
    std::vector<glm::vec2> emission_at;
    for (const auto& vertex : vertices) emission_at.push_back(vertex.colour);
    return cut(material, uneven, {0, 1, 2, 0, 2, 3}, emission_at, 0, times, textures, vertices);
  }

  // Of all pieces for which `where` holds of their middle [m2].
  template <typename Where>
  double area(const std::vector<Cut>& cuts, const Where& where) const {
    double sum = 0;
    for (const auto& one : cuts)
      for (std::size_t i = 0; i < one.indices.size(); i += 3) {
        const glm::vec3 a = at(one, i), b = at(one, i + 1), c = at(one, i + 2);
        if (where((a + b + c) / 3.0f)) sum += glm::length(glm::cross(b - a, c - a)) / 2;
      }
    return sum;
  }
  double area(const std::vector<Cut>& cuts) const {
    return area(cuts, [](const glm::vec3&) { return true; });
  }

  // [W sr^-1 m^-2 m^2]
  glm::vec3 power(const std::vector<Cut>& cuts) const {
    glm::vec3 sum(0);
    for (const auto& one : cuts) sum += static_cast<float>(area({one})) * one.material.emission;
    return sum;
  }

  const glm::vec3& at(const Cut& one, std::size_t i) const { return vertices[one.indices[i]].position; }

  Material material;
  std::vector<Texture> textures;
  std::vector<Vertex> vertices;
};

// Its left half black and clear, its right white and opaque.
Texture half() {
  Texture texture{64, 1, {}};
  for (int x = 0; x < 64; ++x) texture.rgba.insert(texture.rgba.end(), 4, x < 32 ? 0 : 255);
  return texture;
}

TEST(SceneCut, ALampShinesWhereItsTextureIsBright) {
  Sheet sheet;
  sheet.material.emission = glm::vec3(5, 2, 1);
  sheet.textures = {half()};
  const auto cuts = sheet.cut_by({.emission = 0, .wrap = {Wrap::clamp, Wrap::clamp}});
  EXPECT_NEAR(sheet.area(cuts), 2, 1e-4) << "nothing is lost";
  EXPECT_NEAR(sheet.power(cuts).r, 5, 0.1);
  EXPECT_NEAR(sheet.power(cuts).b, 1, 0.02);
  double dark = 0, bright = 0;
  for (const auto& one : cuts) {
    if (one.material.emission.r < 0.01f)
      dark += sheet.area({one}, [](const glm::vec3& at) { return at.x < 1; });
    if (one.material.emission.r > 4.9f)
      bright += sheet.area({one}, [](const glm::vec3& at) { return at.x > 1; });
  }
  EXPECT_GT(dark, 0.9);
  EXPECT_GT(bright, 0.9);
}

TEST(SceneCut, AMaskLeavesHoles) {
  Sheet sheet;
  sheet.textures = {half()};
  sheet.material.texture = 0;
  sheet.material.wrap = {Wrap::clamp, Wrap::clamp};
  const auto cuts = sheet.cut_by({.alpha = Uneven::Alpha::mask});
  EXPECT_NEAR(sheet.area(cuts), 1, 0.03);
  EXPECT_NEAR(sheet.area(cuts, [](const glm::vec3& at) { return at.x > 1; }), 1, 0.03);
  // Where none may be cut, one of the two triangles is there.
  Sheet whole = Sheet();
  whole.textures = {half()};
  whole.material.texture = 0;
  EXPECT_NEAR(whole.area(whole.cut_by({.alpha = Uneven::Alpha::mask}, 0)), 1, 1e-6);
}

TEST(SceneCut, AMaskOfAlphaAloneIsThereOrNot) {
  for (const auto& [alpha, there] : {std::pair{0.4f, 0.0}, {0.6f, 2.0}}) {
    Sheet sheet;
    const auto cuts = sheet.cut_by({.alpha = Uneven::Alpha::mask, .alpha_factor = alpha});
    EXPECT_NEAR(sheet.area(cuts), there, 1e-6);
    EXPECT_EQ(sheet.vertices.size(), 4u) << "an even sheet is not cut";
  }
}

TEST(SceneCut, AVeilIsThereAsOftenAsItIsOpaque) {
  Sheet sheet;
  const auto cuts = sheet.cut_by({.alpha = Uneven::Alpha::blend, .alpha_factor = 0.3f});
  EXPECT_NEAR(sheet.area(cuts), 0.6, 0.01);
  for (int x = 0; x < 4; ++x)  // everywhere
    EXPECT_NEAR(sheet.area(cuts, [&](const glm::vec3& at) { return at.x * 2 > x && at.x * 2 < x + 1; }), 0.15,
                0.03);
  ASSERT_EQ(cuts.size(), 1u);
  EXPECT_EQ(cuts[0].material.base_colour, glm::vec3(1));
}

TEST(SceneCut, GlassLetsThroughWhatItsColourSays) {
  Sheet clear;
  EXPECT_THAT(clear.cut_by({.transmission = 1}), ::testing::IsEmpty());
  Sheet grey;
  grey.material.base_colour = glm::vec3(0.5f);
  const auto cuts = grey.cut_by({.transmission = 0.5f});
  EXPECT_NEAR(grey.area(cuts), 2 * 0.75, 0.01);
  ASSERT_EQ(cuts.size(), 1u);
  // What is there reflects what the half that lets nothing through does.
  EXPECT_NEAR(cuts[0].material.base_colour.r * 0.75, 0.5 * 0.5, 1e-3);
}

TEST(SceneCut, ThereAreNeverTooManyPieces) {
  EXPECT_EQ(cuts_for(2), 5);
  EXPECT_EQ(cuts_for(50'000), 1);
  EXPECT_EQ(cuts_for(1'000'000), 0);
}

TEST(SceneCut, ScenesAreReadInEvenPieces) {
  SceneBuilder builder;
  const int veil = builder.material(glm::vec3(0.5f)), lamp = builder.material({}, glm::vec3(3));
  auto& materials = builder.gltf["materials"];
  materials[0]["alphaMode"] = "BLEND";
  materials[0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.5};
  const std::array<glm::vec3, 4> square = {glm::vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  builder.quad("veil", square, {0, 0, 0.4f, 1}, veil);
  builder.quad("lamp", square, {0.6f, 0, 1, 1}, lamp);
  const TempFolder folder;
  LogCapture log;
  const Scene scene = load(folder.write("scene.glb", builder.glb()));
  double veiled = 0, lit = 0;
  for (const auto& surface : scene.surfaces)
    for (std::uint32_t i = 0; i < surface.index_count; i += 3) {
      const auto at = [&](std::uint32_t k) {
        return scene.vertices[scene.indices[surface.first_index + i + k]];
      };
      (surface.node == "veil" ? veiled : lit) +=
          glm::length(glm::cross(at(1).position - at(0).position, at(2).position - at(0).position)) / 2;
    }
  EXPECT_NEAR(veiled, 0.5, 0.01);
  EXPECT_NEAR(lit, 1, 1e-6);
  materials[0]["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 2;
  EXPECT_THROW(load(folder.write("bad.glb", builder.glb())), SceneError);
}

}  // namespace
}  // namespace lichtveld::scene
