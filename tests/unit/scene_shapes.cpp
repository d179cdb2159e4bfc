// Where meshes are: morph targets, skins, instances.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "lichtveld/scene/scene.hpp"
#include "scene_damage.hpp"
#include "scene_log.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;
using testing::instanced;
using testing::morphing;
using testing::skinned;
using testing::vectors;

const std::vector<glm::vec3> up(4, {0, 1, 0});

void expect_at(const Scene& scene, std::size_t vertex, const glm::vec3& place, const glm::vec3& normal) {
  const Vertex& found = scene.vertices[vertex];
  EXPECT_LT(glm::distance(found.position, place), 1e-5f)
      << found.position.x << " " << found.position.y << " " << found.position.z;
  EXPECT_LT(glm::distance(found.normal, normal), 1e-5f)
      << found.normal.x << " " << found.normal.y << " " << found.normal.z;
}

TEST(SceneShapes, MorphTargetsMoveByTheirWeights) {
  SceneBuilder builder = morphing();
  expect_at(loaded(builder), 0, {-1, 0, 1}, {0, 1, 0});
  builder.gltf["meshes"][0]["weights"] = {0.5, 0};
  expect_at(loaded(builder), 0, {-1, 0.5f, 1}, {0, 1, 0});
  builder.node(0)["weights"] = {-1, 1};  // the node's stand for the mesh's
  expect_at(loaded(builder), 0, {1, -1, 1}, {std::sqrt(0.5f), std::sqrt(0.5f), 0});
  builder.node(0)["weights"] = {2};  // the rest are 0
  expect_at(loaded(builder), 0, {-1, 2, 1}, {0, 1, 0});
  builder.node(0)["weights"] = {0, 0, 7};  // and what is over moves nothing
  expect_at(loaded(builder), 0, {-1, 0, 1}, {0, 1, 0});
}

TEST(SceneShapes, DeltasMayBeSparseAlone) {
  SceneBuilder builder = morphing();
  const int values = vectors(builder, {{0, 5, 0}});
  const int indices = builder.accessor(std::vector<std::uint16_t>{2}, 5123, "SCALAR");
  auto& delta = accessor_json(builder, builder.primitive(0)["targets"][0]["POSITION"].get<int>());
  delta["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", accessor_json(builder, indices)["bufferView"]}, {"componentType", 5123}}},
      {"values", {{"bufferView", accessor_json(builder, values)["bufferView"]}}}};
  delta.erase("bufferView");
  builder.node(0)["weights"] = {1, 0};
  const Scene scene = loaded(builder);
  expect_at(scene, 0, {-1, 0, 1}, {0, 1, 0});
  expect_at(scene, 2, {1, 5, -1}, {0, 1, 0});
}

TEST(SceneShapes, BadTargetsAreRefused) {
  SceneBuilder builder = morphing();
  builder.node(0)["weights"] = {1, 1};
  const auto target = [](SceneBuilder& b) -> json& { return b.primitive(0)["targets"][0]; };
  expect_refused(
      builder,
      {{"Few", [&](auto& b) { accessor_json(b, target(b)["POSITION"].template get<int>())["count"] = 3; },
        "node \"floor\", primitive 0, target 0: POSITION has fewer elements"},
       {"Absent", [&](auto& b) { target(b)["POSITION"] = 99; }, "target 0, POSITION: there is no accessor 99"},
       {"Kind", [&](auto& b) { target(b)["POSITION"] = 1; }, "expected VEC3"},
       {"Nan",
        [&](auto& b) { overwrite(b, target(b)["POSITION"].template get<std::size_t>(), 0, std::nanf("")); },
        "vertex 0 is not finite"},
       {"Huge",
        [&](auto& b) {
          b.node(0)["weights"] = {1e300, 0};
        },
        "vertex 0 is not finite or more than"}});
}

TEST(SceneShapes, SkinsFollowTheirJoints) {
  SceneBuilder builder = skinned();
  expect_at(loaded(builder), 0, {-1, 0, 1}, {0, 1, 0});
  expect_at(loaded(builder), 1, {1, 0, 1}, {0, 1, 0});
  builder.node(3)["rotation"] = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};  // about (1, 0, 0), +y to -x
  attributes(builder)["NORMAL"] = vectors(builder, up);
  expect_at(loaded(builder), 0, {-1, 0, 1}, {0, 1, 0});
  expect_at(loaded(builder), 1, {1, 0, 1}, {-1, 0, 0});
  builder.node(2)["translation"] = {0, 4, 0};
  expect_at(loaded(builder), 1, {1, 4, 1}, {-1, 0, 0});
}

TEST(SceneShapes, WithoutInverseBindMatricesJointsPlaceVertices) {
  const SceneBuilder builder = skinned(false);
  expect_at(loaded(builder), 0, {-1, 0, 1}, {0, 1, 0});
  expect_at(loaded(builder), 1, {2, 0, 1}, {0, 1, 0});
}

TEST(SceneShapes, WeightsOfAnyKindBlend) {
  const auto with = [](auto weights, int type) {
    SceneBuilder builder = skinned();
    builder.node(3)["translation"] = {1, 4, 0};
    attributes(builder)["JOINTS_0"] =
        builder.accessor(std::vector(4, std::array<std::uint16_t, 4>{0, 1, 0, 0}), 5123, "VEC4");
    const int accessor = builder.accessor(std::vector(4, weights), type, "VEC4");
    accessor_json(builder, accessor)["normalized"] = type != 5126;
    attributes(builder)["WEIGHTS_0"] = accessor;
    return loaded(builder).vertices[0].position.y;
  };
  EXPECT_NEAR(with(glm::vec4(0.25f, 0.75f, 0, 0), 5126), 3, 1e-5f);
  EXPECT_NEAR(with(glm::vec4(0.5f, 1.5f, 0, 0), 5126), 3, 1e-5f) << "their sum counts for 1";
  EXPECT_NEAR(with(std::array<std::uint8_t, 4>{51, 204, 0, 0}, 5121), 3.2f, 1e-5f);
  EXPECT_NEAR(with(std::array<std::uint16_t, 4>{0, 65535, 0, 0}, 5123), 4, 1e-5f);
  EXPECT_NEAR(with(glm::vec4(0), 5126), 0, 1e-5f) << "of none the first joint";
}

TEST(SceneShapes, ASkinMovesWithTheNodeThatWearsIt) {
  SceneBuilder builder = skinned();
  builder.set_movable(0);
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.vertices[0].body, 1u);
  EXPECT_EQ(scene.bodies[1].box.min, glm::vec3(-1, 0, -1));
}

TEST(SceneShapes, MirroringJointsKeepTheFrontInFront) {
  SceneBuilder builder = skinned();
  builder.node(2)["scale"] = {-1, 1, 1};
  const Scene scene = loaded(builder);
  const auto p = [&](std::size_t k) { return scene.vertices[scene.indices[k]].position; };
  EXPECT_GT(glm::cross(p(1) - p(0), p(2) - p(0)).y, 0);
  EXPECT_GT(scene.vertices[0].normal.y, 0);
}

TEST(SceneShapes, BadSkinsAreRefused) {
  const auto skin = [](SceneBuilder& b) -> json& { return b.gltf["skins"][0]; };
  const auto index_of = [](SceneBuilder& b, const char* name) {
    return attributes(b)[name].get<std::size_t>();
  };
  expect_refused(
      skinned(),
      {{"Skin", [&](auto& b) { b.node(0)["skin"] = 4; }, "node \"floor\": there is no skin 4"},
       {"SkinBelow", [&](auto& b) { b.node(0)["skin"] = -4; }, "there is no skin -4"},
       {"Joint", [&](auto& b) { overwrite(b, index_of(b, "JOINTS_0"), 4, std::uint8_t{2}); },
        "primitive 0: vertex 1 follows joint 2 of 2"},
       {"Weight", [&](auto& b) { overwrite(b, index_of(b, "WEIGHTS_0"), 0, -1.0f); },
        "a weight of vertex 0 is no number of 0 or more"},
       {"WeightNan", [&](auto& b) { overwrite(b, index_of(b, "WEIGHTS_0"), 0, std::nanf("")); },
        "a weight of vertex 0 is no number"},
       {"NoWeights", [&](auto& b) { attributes(b).erase("WEIGHTS_0"); },
        "has only one of JOINTS_0 and WEIGHTS_0"},
       {"Matrices",
        [&](auto& b) {
          skin(b)["joints"] = {2, 3, 2};
        },
        "fewer inverseBindMatrices than joints"},
       {"MatrixKind", [&](auto& b) { skin(b)["inverseBindMatrices"] = 0; }, "expected MAT4 of float"},
       {"MatrixAbsent", [&](auto& b) { skin(b)["inverseBindMatrices"] = 99; }, "there is no accessor 99"}});
}

json& instance_attributes(SceneBuilder& b) {
  return b.node(0)["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
}

TEST(SceneShapes, InstancesAreTheMeshAgain) {
  SceneBuilder builder = instanced();
  builder.node(0)["translation"] = {0, 1, 0};
  Scene scene = loaded(builder);
  ASSERT_EQ(scene.surfaces.size(), 3u);
  for (const Surface& surface : scene.surfaces) EXPECT_EQ(surface.node, "floor");
  EXPECT_EQ(scene.bodies[0].box.min, glm::vec3(-1, 1, -1));
  EXPECT_EQ(scene.bodies[0].box.max, glm::vec3(7, 1, 1));

  const std::array<std::int16_t, 4> half_turn = {0, 32767, 0, 0};
  const int rotation = builder.accessor(std::vector(3, half_turn), 5122, "VEC4");
  accessor_json(builder, rotation)["normalized"] = true;
  instance_attributes(builder)["ROTATION"] = rotation;
  instance_attributes(builder)["SCALE"] = vectors(builder, {{1, 1, 1}, {1, 1, 1}, {2, 1, 1}});
  builder.set_movable(0);
  scene = loaded(builder);
  EXPECT_EQ(scene.bodies[1].box.max, glm::vec3(8, 1, 1));
  EXPECT_LT(glm::distance(scene.vertices[0].position, {1, 1, -1}), 1e-5f);
}

TEST(SceneShapes, BadInstancesAreRefused) {
  expect_refused(
      instanced(),
      {{"None",
        [](auto& b) {
          b.node(0)["extensions"]["EXT_mesh_gpu_instancing"] = {{"count", 3}};
        },
        "node \"floor\": EXT_mesh_gpu_instancing: has no attributes"},
       {"Unequal", [](auto& b) { instance_attributes(b)["SCALE"] = vectors(b, up); },
        "SCALE is of 4 instances, another of 3"},
       {"Kind",
        [](auto& b) {
          instance_attributes(b)["ROTATION"] = vectors(b, {up[0], up[0], up[0]});
        },
        "ROTATION (accessor 4): expected VEC4"},
       {"Absent", [](auto& b) { instance_attributes(b)["TRANSLATION"] = 99; }, "there is no accessor 99"},
       {"NoNumber", [](auto& b) { instance_attributes(b)["TRANSLATION"] = "x"; }, "TRANSLATION is no accessor"},
       {"Nan", [](auto& b) { overwrite(b, 3, 0, std::nanf("")); }, "translation holds a number"},
       {"Endless",
        [](auto& b) {
          accessor_json(b, 3).erase("bufferView");
          accessor_json(b, 3)["count"] = 1ull << 60;
        },
        "more than 100000 instances"}});
}

// Whatever is done to such a file, it is read or refused.
TEST(SceneShapes, Damage) {
  testing::LogCapture log;
  std::mt19937 random(1);
  SceneBuilder morphing_one = morphing();
  morphing_one.node(0)["weights"] = {0.5, 1};
  const std::vector<std::string> files = {morphing_one.glb(), skinned().glb(), skinned(false).glb(),
                                          instanced().glb()};
  const TempFolder folder;
  for (int round = 0; round < 2000; ++round) {
    std::string bytes = files[static_cast<std::size_t>(round) % files.size()];
    for (std::size_t hits = 1 + random() % 3; hits > 0; --hits) {
      char& byte = bytes[random() % bytes.size()];
      byte = byte >= '0' && byte <= '9' ? static_cast<char>('0' + random() % 10) : static_cast<char>(random());
    }
    error_of(folder.write("damaged.glb", bytes));
  }
}

}  // namespace
}  // namespace lichtveld::scene
