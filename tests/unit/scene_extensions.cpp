// Extensions that files require, and files without a scene.
#include <gmock/gmock.h>

#include <algorithm>

#include "lichtveld/scene/scene.hpp"
#include "scene_damage.hpp"
#include "scene_log.hpp"

namespace lichtveld::scene {
namespace {

using testing::LogCapture;

TEST(SceneExtensions, WhatChangesNoLightIsAccepted) {
  LogCapture log;
  for (const char* extension :
       {"KHR_materials_clearcoat", "KHR_materials_sheen", "KHR_materials_ior", "KHR_materials_specular",
        "KHR_materials_iridescence", "KHR_materials_anisotropy", "KHR_materials_variants",
        "KHR_materials_unlit", "KHR_animation_pointer", "KHR_xmp_json_ld", "MSFT_lod", "KHR_texture_basisu",
        "EXT_mesh_gpu_instancing"}) {
    SceneBuilder builder = sound();
    builder.gltf["extensionsRequired"] = {extension};
    EXPECT_EQ(error_of_bytes(builder.glb()), "no error") << extension;
    EXPECT_EQ(log.take(), "") << extension;
  }
}

TEST(SceneExtensions, UnknownOnesAreNamedOnce) {
  LogCapture log;
  SceneBuilder builder = sound();
  builder.gltf["extensionsRequired"] = {"ACME_wobble", "ACME_glow", "KHR_materials_sheen"};
  EXPECT_EQ(error_of_bytes(builder.glb()), "no error");
  const std::string lines = log.take();
  EXPECT_THAT(lines, ::testing::HasSubstr("requires ACME_glow, ACME_wobble, unknown here"));
  EXPECT_EQ(std::ranges::count(lines, '\n'), 1) << lines;
}

TEST(SceneExtensions, GeometryByAnUnknownOneIsRefused) {
  SceneBuilder builder = sound();
  builder.gltf["extensionsRequired"] = {"ACME_mesh_compression"};
  expect_refused(
      builder,
      {{"Primitive",
        [](auto& b) {
          b.primitive(0)["extensions"]["ACME_mesh_compression"]["bufferView"] = 0;
          accessor_json(b, 0).erase("bufferView");
        },
        "mesh 0, primitive 0 is there by ACME_mesh_compression alone, which is not read; undo it with npx"},
       {"View",
        [](auto& b) {
          b.gltf["bufferViews"][1]["extensions"]["ACME_mesh_compression"] = {{"count", 1}};
        },
        "buffer view 1 is there by ACME_mesh_compression alone"}});
}

TEST(SceneExtensions, DamagedListsAreNoHarm) {
  LogCapture log;
  for (const nlohmann::json& list :
       {nlohmann::json(3), nlohmann::json({1, nullptr}), nlohmann::json::object()}) {
    SceneBuilder builder = sound();
    builder.gltf["extensionsRequired"] = list;
    EXPECT_NE(error_of_bytes(builder.glb()), "") << list;
  }
}

TEST(SceneExtensions, HiddenNodesAreLeftOut) {
  LogCapture log;
  SceneBuilder builder = sound();
  builder.quad("ghost", {glm::vec3{-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}}, {0, 0, 0.05f, 0.05f}, 0);
  builder.gltf["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  builder.node(2)["extensions"]["KHR_lights_punctual"]["light"] = 0;
  builder.gltf["nodes"].push_back({{"name", "group"}, {"children", {2}}});
  builder.gltf["scenes"][0]["nodes"] = {0, 3};
  EXPECT_EQ(loaded(builder).surfaces.size(), 2u);
  builder.node(3)["extensions"]["KHR_node_visibility"]["visible"] = false;
  builder.gltf["extensionsRequired"] = {"KHR_node_visibility"};
  const Scene scene = loaded(builder);
  EXPECT_EQ(scene.surfaces.size(), 1u);
  EXPECT_TRUE(scene.punctual.empty());
}

TEST(SceneExtensions, WithoutScenesAllRootsAreShown) {
  SceneBuilder builder = sound();
  builder.quad("ceiling", {glm::vec3{-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}}, {0, 0, 0.05f, 0.05f}, 0);
  builder.gltf["nodes"].push_back({{"name", "group"}, {"children", {2}}, {"translation", {0, 1, 0}}});
  builder.gltf.erase("scene");
  builder.gltf.erase("scenes");
  const Scene scene = loaded(builder);
  ASSERT_EQ(scene.surfaces.size(), 2u);
  EXPECT_EQ(scene.bodies[0].box.max.y, 4) << "children are reached by their parents alone";
}

TEST(SceneExtensions, WithoutScenesCyclesAreNothing) {
  SceneBuilder builder = sound();
  builder.gltf.erase("scenes");
  builder.gltf.erase("scene");
  builder.gltf["nodes"][1]["children"] = {0};
  EXPECT_THAT(error_of_bytes(builder.glb()), ::testing::HasSubstr("no triangles"));
}

}  // namespace
}  // namespace lichtveld::scene
