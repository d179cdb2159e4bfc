// Where charts meet, and charts that hold no texel: what players see there.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <random>

#include "core/seams.hpp"
#include "device_for_tests.hpp"
#include "known_scenes.hpp"
#include "lichtveld/scene/seams.hpp"
#include "light_fields.hpp"

namespace lichtveld::lightfield {
namespace {

using namespace lichtveld::testing;

constexpr std::uint32_t size = 64;

// A floor of two halves that meet at x = 0, whose charts are turned against each other and differ in scale; a
// wall at its left end; a small lamp that shines along it.
SceneBuilder halves() {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f));
  builder.quad("left", {glm::vec3(-2, 0, 1), {0, 0, 1}, {0, 0, -1}, {-2, 0, -1}}, {0.03f, 0.03f, 0.47f, 0.43f},
               grey);
  builder.quad("right", {glm::vec3(0, 0, -1), {0, 0, 1}, {2, 0, 1}, {2, 0, -1}}, {0.53f, 0.03f, 0.85f, 0.47f},
               grey);
  builder.quad("wall", {glm::vec3(-2, 0, 1), {-2, 0, -1}, {-2, 1, -1}, {-2, 1, 1}}, {0.03f, 0.53f, 0.47f, 0.9f},
               grey);
  square(builder, "lamp", 0.6f, true, {0.6f, 0.6f, 0.7f, 0.7f}, builder.material(glm::vec3(0), glm::vec3(9)),
         0.1f, 0.3f);
  return builder;
}

float at(std::span<const float> map, const glm::vec2& place) {
  const glm::vec2 from = place * static_cast<float>(size) - 0.5f, low = glm::floor(from), share = from - low;
  const auto texel = [&](int x, int y) {
    return map[static_cast<std::size_t>((static_cast<int>(low.y) + y) * static_cast<int>(size) +
                                        static_cast<int>(low.x) + x)];
  };
  return glm::mix(glm::mix(texel(0, 0), texel(1, 0), share.x), glm::mix(texel(0, 1), texel(1, 1), share.x),
                  share.y);
}

// The root of the mean square of how far both sides are apart along a seam.
double apart(const scene::Seam& seam, std::span<const float> map) {
  constexpr int places = 200;
  double squares = 0;
  for (int i = 0; i < places; ++i) {
    const float along = (static_cast<float>(i) + 0.5f) / places;
    const auto there = [&](const scene::Seam::Side& side) {
      return at(map, glm::mix(side.from, side.to, along));
    };
    squares += std::pow(there(seam.sides[0]) - there(seam.sides[1]), 2) / places;
  }
  return std::sqrt(squares);
}

const std::string& node_of(const scene::Scene& scene, std::uint32_t triangle) {
  return scene.surfaces[surface_of_triangles(scene)[triangle]].node;
}

TEST(Seams, AreWhereChartsOfOneSmoothSurfaceMeet) {
  const auto scene = loaded(halves());
  const auto seams = scene::find_seams(scene);
  ASSERT_EQ(seams.size(), 1u) << "and not where the floor meets the wall, nor along a square's diagonal";
  EXPECT_THAT(
      (std::array{node_of(scene, seams[0].sides[0].triangle), node_of(scene, seams[0].sides[1].triangle)}),
      ::testing::UnorderedElementsAre("left", "right"));
  auto upside_down = halves();
  upside_down.quad("underside", {glm::vec3(0, 0, 1), {0, 0, -1}, {2, 0, -1}, {2, 0, 1}},
                   {0.53f, 0.53f, 0.58f, 0.58f}, 0);
  EXPECT_EQ(scene::find_seams(loaded(upside_down)).size(), 1u) << "what faces the other way is no neighbour";
}

// What a body does, moves with it.
TEST(Seams, AreNotBetweenBodies) {
  auto builder = halves();
  builder.set_movable(0);
  EXPECT_TRUE(scene::find_seams(loaded(builder)).empty());
}

// Each side shows what it was lit by, a few percent off, and filters along its own texels.
TEST(Seams, AreClosedByTheLeastThatCloses) {
  const auto scene = loaded(halves());
  const TexelRecords records(scene, size);
  const Seams seams(scene, records);
  ASSERT_FALSE(seams.texels().empty());
  std::mt19937 random(3);
  std::normal_distribution<float> noise(1, 0.05f);
  std::vector<glm::vec4> irradiance(size * size, glm::vec4(0));
  for (const auto& record : records.all())
    irradiance[record.atlas] = glm::vec4(glm::vec3(2 + std::sin(record.position.z)) * noise(random), 1);
  std::vector<float> before(size * size);
  for (std::uint32_t texel = 0; texel < before.size(); ++texel)
    if (const auto source = records.source()[texel]; source != no_record)
      before[texel] = 0.5f / std::numbers::pi_v<float> * irradiance[records[source].atlas].g;
  auto after = before;
  const auto offsets = seams.offsets(irradiance);
  ASSERT_EQ(offsets.size(), seams.texels().size());
  double most = 0;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    after[seams.texels()[i]] += offsets[i].g;
    most = std::max<double>(most, std::abs(offsets[i].g));
    EXPECT_LT(std::abs(records[records.source()[seams.texels()[i]]].position.x), 0.1f);
  }
  const auto seam = scene::find_seams(scene).at(0);
  EXPECT_GT(apart(seam, before), 0.01);
  EXPECT_LT(apart(seam, after), 0.1 * apart(seam, before));
  EXPECT_GT(offsets.size(), size / 2);
  EXPECT_LT(most, 4 * apart(seam, before));
  irradiance.assign(irradiance.size(), glm::vec4(1));
  for (const auto& offset : seams.offsets(irradiance)) EXPECT_NEAR(offset.g, 0, 1e-6) << "what agrees stays";
}

// A body that ends at the seam keeps its dark side dark.
TEST(Seams, StayWhereSomethingLies) {
  const auto scene = loaded(halves());
  const TexelRecords records(scene, size);
  std::vector<glm::vec4> irradiance(size * size, glm::vec4(0));
  for (const auto& record : records.all())
    if (record.position.x > 0) irradiance[record.atlas] = glm::vec4(1);
  for (const auto& offset : Seams(scene, records).offsets(irradiance)) EXPECT_EQ(offset, glm::vec3(0));
}

using ShownSeams = WithDevice;

std::vector<float> green_of(const Shown& shown) {
  std::vector<float> values;
  for (std::size_t i = 1; i < shown.bytes.size(); i += 4) values.push_back(shown.bytes[i]);
  return values;
}

TEST_F(ShownSeams, AgreeByEveryEngineAndIrradianceIsWhatItWas) {
  auto builder = halves();  // and a sky, so that by few directions no texel is without light
  square(builder, "sky", 4, true, {0.75f, 0.6f, 0.95f, 0.8f}, builder.material(glm::vec3(0), glm::vec3(2)), 4);
  const auto scene = loaded(builder);
  const auto seam = scene::find_seams(scene).at(0);
  for (const auto& engine : engines()) {
    const auto light = engine.make(device(), scene, {.size = size, .psf = 24});
    settled(*light, at_rest(scene));
    const auto before = light->irradiance();
    EXPECT_LT(apart(seam, green_of(light->shown())), 1) << engine.name << ": of 255";
    EXPECT_EQ(light->irradiance(), before) << engine.name;
  }
}

// Panels a third of a texel wide between whole ones: no texel is theirs.
TEST_F(ShownSeams, ChartsWithoutATexelShowTheirOwnLight) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f)), red = builder.material({0.8f, 0, 0});
  builder.box("room", {-1, 0, -1}, {1, 2, 1}, {0, 0.5f, 0.5f, 1}, grey, true);
  square(builder, "lamp", 1.99f, true, {0.6f, 0.6f, 0.7f, 0.7f}, builder.material(glm::vec3(0), glm::vec3(5)),
         0.3f);
  constexpr glm::vec2 panel(20.6f, 10.6f);  // [texels]
  const glm::vec2 low = panel / 64.0f, high = (panel + 0.3f) / 64.0f;
  square(builder, "panel", 0.4f, false, {low.x, low.y, high.x, high.y}, red, 0.2f);
  const auto scene = loaded(builder);
  const auto light = engine("rays").make(device(), scene, {.size = size});
  settled(*light, at_rest(scene));
  const auto map = light->irradiance();
  const std::size_t texel = 10 * size + 20;
  EXPECT_EQ(map[texel].a, 0) << "it is no texel of the panel's";
  EXPECT_GT(map[texel].g, 0.5) << "but has its light";
  const auto shown = light->shown();
  for (const std::size_t near : {texel, texel + 1, texel + size, texel + size + 1}) {
    EXPECT_GT(shown.bytes[4 * near], 60) << near;
    EXPECT_EQ(shown.bytes[4 * near + 1], 0) << near << ": it is red";
  }
}

}  // namespace
}  // namespace lichtveld::lightfield
