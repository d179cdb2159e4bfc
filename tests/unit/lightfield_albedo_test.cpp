// What texels reflect, where a texture has many pixels in each, or several triangles share one.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "core/texel_albedo.hpp"
#include "core/texel_records.hpp"
#include "known_scenes.hpp"
#include "lichtveld/scene/surface_point.hpp"
#include "rays/rows.hpp"
#include "shapes.hpp"

namespace lichtveld::lightfield {
namespace {

using namespace lichtveld::testing;

// Black and white by turns.
scene::Texture chequers(std::uint32_t side) {
  scene::Texture texture{side, side, {}};
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x)
      for (int channel = 0; channel < 4; ++channel)
        texture.rgba.push_back((x + y) % 2 == 0 || channel == 3 ? 255 : 0);
  return texture;
}

// A floor over the whole atlas, on which a texture lies `turns` times each way.
scene::Scene floor(const scene::Texture& texture, float turns) {
  SceneBuilder builder;
  square(builder, "floor", 0, false, whole_atlas, builder.material(glm::vec3(1)));
  auto scene = loaded(builder);
  scene.textures = {texture};
  scene.materials[scene.surfaces.front().material].texture = 0;
  for (auto& vertex : scene.vertices) vertex.colour = turns * vertex.atlas;
  return scene;
}

struct Spread {
  double mean = 0, deviation = 0;
};

Spread spread_of(const TexelRecords& records) {
  Spread spread;
  for (const auto& record : records.all()) spread.mean += record.albedo.g / records.count();
  for (const auto& record : records.all())
    spread.deviation += (record.albedo.g - spread.mean) * (record.albedo.g - spread.mean) / records.count();
  spread.deviation = std::sqrt(spread.deviation);
  return spread;
}

// At their centres they would be all white or all black, or anything between: the pattern falls in with the
// texels.
TEST(TexelAlbedo, OfAFinePatternIsItsMean) {
  for (const std::uint32_t pixels : {2u, 16u, 64u})
    for (const float turns : {64.0f, 61.3f, 128.0f}) {
      const auto scene = floor(chequers(pixels), turns);
      const auto spread = spread_of(TexelRecords(scene, 64));
      EXPECT_NEAR(spread.mean, 0.5, 0.01) << pixels << " pixels, " << turns << " times";
      EXPECT_LT(spread.deviation, 0.08) << pixels << " pixels, " << turns << " times";
    }
}

TEST(TexelAlbedo, OfACoarseOneIsTheSame) {
  const auto scene = floor(chequers(4), 1);
  const TexelRecords records(scene, 64);
  for (const auto& record : records.all()) {
    const glm::vec2 at = glm::vec2(record.atlas % 64, record.atlas / 64) + 0.5f;
    const auto& material = scene.materials.front();
    const auto there = scene::sample_srgb(scene.textures.front(), at / 64.0f, material.wrap);
    EXPECT_LT(glm::distance(record.albedo, there), 0.05f) << record.atlas;
  }
}

// Slivers of a square, by turns green and red.
scene::Scene striped(Chart chart) {
  SceneBuilder builder;
  sliver_square(builder, "slivers", 0, false, chart, builder.material(glm::vec3(1)), 64);
  auto scene = loaded(builder);
  for (std::uint32_t corner = 0; corner < scene.indices.size(); ++corner) {
    auto vertex = scene.vertices[scene.indices[corner]];
    vertex.tint = corner / 3 % 2 == 0 ? glm::u16vec4(65535, 0, 0, 0) : glm::u16vec4(0, 65535, 0, 0);
    scene.indices[corner] = static_cast<std::uint32_t>(scene.vertices.size());
    scene.vertices.push_back(vertex);
  }
  return scene;
}

TEST(TexelAlbedo, OfSeveralTrianglesIsTheirMean) {
  const auto spread = spread_of(TexelRecords(striped(whole_atlas), 16));
  EXPECT_NEAR(spread.mean, 0.5, 0.02);
  EXPECT_LT(spread.deviation, 0.2);  // 0.5 if each were what lies on its centre
}

// Of what holds no texel's centre, too.
TEST(TexelAlbedo, OfAChartWithoutATexelIsItsMean) {
  const auto scene = striped({8.6f / 16, 8.6f / 16, 8.9f / 16, 8.9f / 16});
  const TexelRecords records(scene, 16);
  ASSERT_EQ(records.count(), 0u);
  const Rows rows(scene, records, 1);
  ASSERT_EQ(rows.count(), 1u);
  EXPECT_LT(glm::distance(rows[0].albedo, glm::vec3(0.5f, 0.5f, 0)), 0.01f);
}

// Beside a corner as far out as a number can be a coordinate is none.
TEST(TexelAlbedo, OfCoordinatesWithoutEndIsOne) {
  auto scene = floor(chequers(4), 1);
  scene.vertices[0].colour = glm::vec2(0, std::numeric_limits<float>::max());
  const TexelRecords records(scene, 64);
  for (const auto& record : records.all()) {
    ASSERT_GE(record.albedo.g, 0);
    ASSERT_LE(record.albedo.g, 1);
  }
  for (const auto wrap : {scene::Wrap::repeat, scene::Wrap::mirror, scene::Wrap::clamp}) {
    const auto value = scene::sample_srgb(scene.textures[0], glm::vec2(INFINITY, -INFINITY), {wrap, wrap});
    EXPECT_TRUE(value.g >= 0 && value.g <= 1);
  }
}

}  // namespace
}  // namespace lichtveld::lightfield
