// check_atlas(): which texels are valid, and who shares them.
#include <gmock/gmock.h>

#include <random>
#include <set>

#include "atlas_raster.hpp"
#include "lichtveld/scene/atlas.hpp"
#include "lichtveld/scene/scene.hpp"
#include "scene_builder.hpp"
#include "scene_log.hpp"

namespace lichtveld::scene {
namespace {

using testing::Chart;
using testing::SceneBuilder;
using testing::TempFolder;

constexpr std::array<glm::vec3, 4> quad_corners = {glm::vec3{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};

Scene scene_with(const std::vector<std::pair<std::string, Chart>>& quads) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f));
  for (const auto& [name, chart] : quads) builder.quad(name, quad_corners, chart, grey);
  const TempFolder folder;
  return load(folder.write("scene.glb", builder.glb()));
}

std::string atlas_error(const Scene& scene, std::uint32_t size) {
  try {
    check_atlas(scene, size);
  } catch (const SceneError& e) {
    return e.what();
  }
  return "no error";
}

// A scene whose atlas stays, however it overlaps.
Scene overlapping(const std::vector<std::pair<std::string, Chart>>& quads) {
  Scene scene = scene_with({{"a", {0, 0, 1, 1}}});
  const Scene one = scene;
  scene.vertices.clear(), scene.indices.clear(), scene.surfaces.clear();
  for (const auto& [name, chart] : quads) {
    auto surface = one.surfaces[0];
    surface.node = name;
    surface.first_index = static_cast<std::uint32_t>(scene.indices.size());
    scene.surfaces.push_back(surface);
    for (const auto index : one.indices)
      scene.indices.push_back(index + static_cast<std::uint32_t>(scene.vertices.size()));
    for (auto vertex : one.vertices) {
      vertex.position.y += static_cast<float>(scene.surfaces.size());
      vertex.atlas = {glm::mix(chart.u0, chart.u1, vertex.atlas.x),
                      glm::mix(chart.v0, chart.v1, vertex.atlas.y)};
      scene.vertices.push_back(vertex);
    }
  }
  return scene;
}

TEST(SceneAtlas, CountsTexelsWhoseCentreLiesOnAChart) {
  const Scene scene = scene_with({{"a", {0.25f, 0.25f, 0.5f, 0.75f}}});
  EXPECT_EQ(check_atlas(scene, 8), 2u * 4u);
  EXPECT_EQ(check_atlas(scene, 256), 64u * 128u);
}

TEST(SceneAtlas, ChartsThatTouchDoNotOverlap) {
  // The border between both runs through texel centres, and so does each quad's diagonal.
  const float middle = 4.5f / 8;
  const Scene scene = scene_with({{"a", {0, 0, middle, 1}}, {"b", {middle, 0, 1, 1}}});
  EXPECT_EQ(check_atlas(scene, 8), 64u);
  EXPECT_EQ(check_atlas(scene, 1024), 1024u * 1024u);
}

TEST(SceneAtlas, OverlapsAreNamedAndCounted) {
  const Scene scene = overlapping(
      {{"floor", {0, 0, 0.5f, 0.5f}}, {"wall", {0.375f, 0.25f, 1, 1}}, {"lamp", {0.75f, 0.6875f, 1, 1}}});
  testing::LogCapture log;
  EXPECT_EQ(check_atlas(scene, 16), 8u * 8 + 10 * 12 - 8);
  const std::string told = log.take();
  EXPECT_THAT(told, ::testing::HasSubstr("\"floor\" and \"wall\" share 8"));
  EXPECT_THAT(told, ::testing::HasSubstr("\"lamp\" and \"wall\" share 20"));
}

TEST(SceneAtlas, OverlapsOfCopiesAreNone) {
  Scene scene = overlapping({{"floor", {0, 0, 1, 1}}, {"again", {0, 0, 1, 1}}});
  testing::LogCapture log;
  check_atlas(scene, 16);
  EXPECT_THAT(log.take(), ::testing::HasSubstr("\"again\" and \"floor\" share 240"));  // all but the diagonal
  for (auto& vertex : scene.vertices) vertex.position.y = 0;
  check_atlas(scene, 16);
  EXPECT_THAT(log.take(), ::testing::IsEmpty());
}

TEST(SceneAtlas, NothingCoveredIsAnError) {
  const Scene scene = scene_with({{"dot", {0.5f, 0.5f, 0.501f, 0.501f}}});
  EXPECT_THAT(atlas_error(scene, 16), ::testing::HasSubstr("no texel of 16 x 16 lies on a chart"));
  EXPECT_THAT(atlas_error(scene, 0), ::testing::HasSubstr("outside 1..16384"));
}

// Columns that cannot hold a centre are left out row by row, and no others.
TEST(SceneAtlas, TexelsOfATriangleAreThoseWhoseCentresItHolds) {
  constexpr std::uint32_t size = 32;
  std::mt19937 random(1);
  const auto share = [&] { return static_cast<float>(random() % 1025) / 1024; };
  for (int round = 0; round < 3000; ++round) {
    std::array<glm::vec2, 3> uv{glm::vec2(share(), share()), {share(), share()}, {share(), share()}};
    if (round % 3 == 0) uv[2] = uv[1] + 0.03f * glm::vec2(share(), share());  // a sliver
    if (round % 7 == 0) uv[1].y = uv[0].y;
    std::set<std::pair<std::uint32_t, std::uint32_t>> found, expected;
    for_texels(uv, size, [&](std::uint32_t i, std::uint32_t j) { found.emplace(i, j); });
    std::array<Snapped, 3> p{snapped(uv[0], size), snapped(uv[1], size), snapped(uv[2], size)};
    if (edge(p[0], p[1], p[2]) < 0) std::swap(p[1], p[2]);
    for (std::uint32_t j = 0; j < size; ++j)
      for (std::uint32_t i = 0; i < size; ++i)
        if (edge(p[0], p[1], p[2]) != 0 && covers(p, {i * subtexels + subtexels / 2, j * subtexels + subtexels / 2}))
          expected.emplace(i, j);
    ASSERT_EQ(found, expected) << round;
  }
}

}  // namespace
}  // namespace lichtveld::scene
