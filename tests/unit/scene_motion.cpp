// Cubes of 1 m in a closed room of 10 m with a thin wall: where steps end.
#include "lichtveld/scene/motion.hpp"

#include <gtest/gtest.h>

#include "scene_builder.hpp"

namespace lichtveld::scene {
namespace {

using testing::SceneBuilder;
using testing::TempFolder;

class SceneCollision : public ::testing::Test {
 protected:
  static Scene make() {
    SceneBuilder builder;
    const int grey = builder.material(glm::vec3(0.5f), glm::vec3(1));
    builder.box("room", glm::vec3(-5), glm::vec3(5), {0, 0, 0.5f, 0.5f}, grey, true);
    builder.quad("thin wall", {glm::vec3{3, -1, 1}, {3, -1, -1}, {3, 1, -1}, {3, 1, 1}}, {0.5f, 0, 1, 0.5f},
                 grey);
    builder.quad("slope", {glm::vec3{-5, -4, -3}, {-5, -4, -5}, {-3, -5, -5}, {-3, -5, -3}}, {0, 0.5f, 0.3f, 1},
                 grey);
    for (const char* name : {"cube1", "cube2"}) {
      const float u = name[4] == '1' ? 0.3f : 0.6f;
      const int cube = builder.box(name, glm::vec3(-0.5f), glm::vec3(0.5f), {u, 0.5f, u + 0.3f, 1}, grey);
      builder.set_movable(cube);
      builder.node(cube)["translation"] = {0, name[4] == '1' ? 0 : 3, 0};
    }
    const TempFolder folder;
    return load(folder.write("scene.glb", builder.glb()));
  }

  // Where cube 1 gets from `offset` by `step`.
  glm::vec3 go(glm::vec3 offset, glm::vec3 step) const { return free_step(scene_, {{}, offset, {}}, 1, step); }

  static void expect_near(glm::vec3 actual, glm::vec3 expected, float tolerance = 1e-3f) {
    EXPECT_LT(glm::distance(actual, expected), tolerance) << actual.x << " " << actual.y << " " << actual.z;
  }

  Scene scene_ = make();
};

TEST_F(SceneCollision, StepIsAShareOfTheScene) {
  EXPECT_NEAR(step_length(scene_), 5 * std::sqrt(3.0f) / 32, 1e-4f);
}

TEST_F(SceneCollision, FreeStepsAreWhole) {
  EXPECT_EQ(go({}, {-1, 0.25f, 0}), glm::vec3(-1, 0.25f, 0));
  EXPECT_EQ(go({}, {}), glm::vec3(0));
}

TEST_F(SceneCollision, WallsStopAtContact) {
  expect_near(go({}, {-7, 0, 0}), {-4.5f, 0, 0});
  expect_near(go({-4.5f, 0, 0}, {-0.3f, 0, 0}), {});
}

TEST_F(SceneCollision, RepeatedPushesNeverCreepThroughAWall) {
  glm::vec3 offset(0);
  for (int i = 0; i < 2000; ++i) offset += go(offset, {-0.3f, 0, 0});
  expect_near(offset, {-4.5f, 0, 0});
}

TEST_F(SceneCollision, ThinWallsCannotBeTunnelledThrough) {
  expect_near(go({}, {4.4f, 0, 0}), {2.5f, 0, 0});
  expect_near(go({4, 0, 0}, {-4.4f, 0, 0}), {-0.5f, 0, 0});  // from behind as well
  EXPECT_EQ(go({0, 2, 0}, {4, 0, 0}), glm::vec3(4, 0, 0)) << "above the wall, touching cube 2";
  EXPECT_EQ(go({0, -2, 0}, {4, 0, 0}), glm::vec3(4, 0, 0)) << "below the wall";
}

TEST_F(SceneCollision, EdgesAndSlopesCount) {
  // The slope's plane: y = -4 - (x + 5) / 2 up to the corner; the cube's lower edge x = -4 meets it at y =
  // -4.5.
  expect_near(go({-3.5f, -3, -4}, {0, -2, 0}), {0, -1, 0});
}

TEST_F(SceneCollision, OtherCubesStop) {
  expect_near(go({}, {0, 4, 0}), {0, 2, 0});
  expect_near(free_step(scene_, {{}, {}, {0, -1, 0}}, 1, {0, 4, 0}), {0, 1, 0});
  expect_near(free_step(scene_, {{}, {}, {}}, 2, {0, -4, 0}), {0, -2, 0});
}

TEST_F(SceneCollision, RestingCubesSlide) {
  EXPECT_EQ(go({0, -4.5f, 0}, {2, 0, 0}), glm::vec3(2, 0, 0));       // on the floor
  EXPECT_EQ(go({-2, 2, 0}, {1, 0, 0}), glm::vec3(1, 0, 0));          // until it is beside cube 2
  EXPECT_EQ(go({2.5f, 0, 0}, {0, 0.5f, 0}), glm::vec3(0, 0.5f, 0));  // along the thin wall
  const glm::vec3 reached = go({}, {-7, 0, 0});  // where a contact left it, not where it was put
  EXPECT_EQ(go(reached, {0, -1, 0}), glm::vec3(0, -1, 0));
}

TEST_F(SceneCollision, StuckCubesMayLeaveButNotGoDeeper) {
  EXPECT_EQ(go({-4.7f, 0, 0}, {-0.1f, 0, 0}), glm::vec3(0));
  EXPECT_EQ(go({-4.7f, 0, 0}, {0.5f, 0, 0}), glm::vec3(0.5f, 0, 0));
  EXPECT_EQ(go({-4.7f, 0, 0}, {0, 0.5f, 0}), glm::vec3(0, 0.5f, 0));
  EXPECT_EQ(go({0, 2.4f, 0}, {0, 0.1f, 0}), glm::vec3(0)) << "into cube 2";
  EXPECT_EQ(go({0, 2.4f, 0}, {0, -1, 0}), glm::vec3(0, -1, 0)) << "out of cube 2";
}

TEST_F(SceneCollision, NonsenseStepsStayWhereTheyAre) {
  EXPECT_EQ(go({}, glm::vec3(std::nanf(""))), glm::vec3(0));
  EXPECT_EQ(go({}, glm::vec3(INFINITY, 0, 0)), glm::vec3(0));
}

}  // namespace
}  // namespace lichtveld::scene
