// The lines on a floor [-1, 1]^2 at y = 0 where something stands on it or falls away from it.
#include "lichtveld/scene/walls.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene_builder.hpp"

namespace lichtveld::scene {
namespace {

using testing::Chart;
using testing::SceneBuilder;
using testing::TempFolder;

constexpr float gap = 0.01f, reach = 0.5f;
constexpr Chart floor_chart{0, 0, 0.4f, 0.4f}, other_chart{0.5f, 0, 0.9f, 0.4f};

struct Floor : SceneBuilder {
  Floor() { quad("floor", {glm::vec3(-1, 0, 1), {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}, floor_chart, grey); }

  // What leaves the floor at x = 1, at this angle to it [degrees]: 90 is a wall, -90 the side of a table.
  Floor& fold(float degrees) {
    const float angle = degrees * std::numbers::pi_v<float> / 180, x = 1 + std::cos(angle), y = std::sin(angle);
    quad("fold", {glm::vec3(1, 0, 1), {x, y, 1}, {x, y, -1}, {1, 0, -1}}, other_chart, grey);
    return *this;
  }

  // A cube of side 0.4 about z = 0.
  Floor& block(float bottom, float x = 0) {
    set_movable(box("block", {x - 0.2f, bottom, -0.2f}, {x + 0.2f, bottom + 0.4f, 0.2f}, other_chart, grey));
    return *this;
  }

  // Those of the floor's own two triangles, the last body shifted.
  std::vector<Wall> walls(glm::vec3 shift = glm::vec3(0)) const {
    const TempFolder folder;
    const auto scene = load(folder.write("scene.glb", glb()));
    EXPECT_EQ(scene.surfaces.front().node, "floor");
    std::vector<glm::vec3> offsets(scene.bodies.size(), glm::vec3(0));
    offsets.back() = shift;
    const auto found = find_walls(scene, offsets, gap, reach);
    EXPECT_EQ(found.first.size(), scene.indices.size() / 3 + 1);
    EXPECT_EQ(found.first.back(), found.lines.size());
    return {found.lines.begin() + found.first[0], found.lines.begin() + found.first[2]};
  }

 private:
  int grey = material(glm::vec3(0.5f), glm::vec3(1));
};

void expect_the_edge_at_x_1(const std::vector<Wall>& walls, bool rises) {
  ASSERT_FALSE(walls.empty());
  for (const auto& wall : walls) {
    EXPECT_EQ(wall.rises, rises);
    for (const auto& end : {wall.a, wall.b}) {
      EXPECT_NEAR(end.x, 1, 1e-6);
      EXPECT_NEAR(end.y, 0, 1e-6);
      EXPECT_NEAR(std::abs(end.z), 1, 1e-6);
    }
  }
}

TEST(SceneWalls, AWallRisesFromTheLineThatItStandsOn) {
  expect_the_edge_at_x_1(Floor().fold(90).walls(), true);
}

TEST(SceneWalls, NothingRisesFromAConvexEdge) {
  expect_the_edge_at_x_1(Floor().fold(-90).walls(), false);
}

TEST(SceneWalls, WhatContinuesThePlaneOrBendsSmoothlyIsNone) {
  for (const float degrees : {0.0f, 30.0f, -30.0f})
    EXPECT_TRUE(Floor().fold(degrees).walls().empty()) << degrees;
}

// The four sides of a block about (x, z) = middle.
void expect_feet(const std::vector<Wall>& walls, glm::vec2 middle) {
  double length = 0;
  for (const auto& wall : walls) {
    EXPECT_TRUE(wall.rises);
    EXPECT_NEAR(wall.a.y, 0, 1e-6);
    EXPECT_NEAR(wall.b.y, 0, 1e-6);
    const glm::vec2 a = glm::vec2(wall.a.x, wall.a.z) - middle, b = glm::vec2(wall.b.x, wall.b.z) - middle;
    for (const auto& end : {a, b}) EXPECT_NEAR(std::max(std::abs(end.x), std::abs(end.y)), 0.2, 1e-5);
    EXPECT_TRUE(std::abs(a.x - b.x) < 1e-5 || std::abs(a.y - b.y) < 1e-5) << "a diagonal";
    length += glm::distance(a, b);
  }
  // Each of the floor's two triangles has all four sides within its reach.
  EXPECT_NEAR(length, 2 * 4 * 0.4, 1e-4);
}

TEST(SceneWalls, ABlockStandsOnItsFourSides) {
  expect_feet(Floor().block(0).walls(), {0, 0});
}

TEST(SceneWalls, AGapWithinTheToleranceIsNoGap) {
  expect_feet(Floor().block(0.8f * gap).walls(), {0, 0});
}

TEST(SceneWalls, AWiderGapIsOne) {
  EXPECT_TRUE(Floor().block(1.2f * gap).walls().empty());
}

TEST(SceneWalls, FollowABodyThatMoves) {
  EXPECT_TRUE(Floor().block(1).walls().empty()) << "it hangs a metre high";
  expect_feet(Floor().block(1).walls({0.1f, -1, -0.1f}), {0.1f, -0.1f});
}

TEST(SceneWalls, WhatIsOutOfReachIsLeftOut) {
  EXPECT_FALSE(Floor().block(0, 1.2f + 0.9f * reach).walls().empty());
  EXPECT_TRUE(Floor().block(0, 1.2f + 1.1f * reach).walls().empty());
}

}  // namespace
}  // namespace lichtveld::scene
