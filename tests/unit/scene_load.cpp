// What load() makes of sound files.
#include <gmock/gmock.h>

#include "lichtveld/scene/atlas.hpp"
#include "lichtveld/scene/scene.hpp"
#include "scene_builder.hpp"
#include "scene_pictures.hpp"

namespace lichtveld::scene {
namespace {

using testing::Chart;
using testing::SceneBuilder;
using testing::TempFolder;
using testing::text_of;

constexpr std::array<glm::vec3, 4> floor_corners = {glm::vec3{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
constexpr Chart whole_chart{0.1f, 0.1f, 0.9f, 0.9f};

Scene load_built(const SceneBuilder& builder) {
  const TempFolder folder;
  return load(folder.write("scene.glb", builder.glb()));
}

glm::vec3 face_normal(const Scene& scene, std::size_t triangle) {
  const auto p = [&](std::size_t k) { return scene.vertices[scene.indices[3 * triangle + k]].position; };
  return glm::normalize(glm::cross(p(1) - p(0), p(2) - p(0)));
}

void expect_near(glm::vec3 actual, glm::vec3 expected) {
  EXPECT_LT(glm::distance(actual, expected), 1e-5f) << actual.x << " " << actual.y << " " << actual.z;
}

TEST(SceneLoad, ReadsQuadMaterialAndEmission) {
  SceneBuilder builder;
  builder.quad("floor", floor_corners, whole_chart, builder.material({0.5f, 0.25f, 1}, {4, 2, 0}));
  const Scene scene = load_built(builder);
  ASSERT_EQ(scene.surfaces.size(), 1u);
  EXPECT_EQ(scene.surfaces[0].node, "floor");
  EXPECT_EQ(scene.surfaces[0].index_count, 6u);
  EXPECT_EQ(scene.one_sided_indices, 6u);
  const Material& material = scene.materials[scene.surfaces[0].material];
  expect_near(material.base_colour, {0.5f, 0.25f, 1});
  expect_near(material.emission, {4, 2, 0});
  EXPECT_EQ(scene.vertices[scene.indices[0]].atlas, glm::vec2(0.1f, 0.9f));
  ASSERT_EQ(scene.bodies.size(), 1u);
  expect_near(scene.bodies[0].box.min, {-1, 0, -1});
}

TEST(SceneLoad, RoundingBeyondTheUnitSquareIsPulledBack) {
  SceneBuilder builder;
  builder.quad("floor", floor_corners, {-5e-6f, 0, 1.000005f, 1}, builder.material(glm::vec3(1)));
  for (const Vertex& vertex : load_built(builder).vertices) {
    EXPECT_GE(vertex.atlas.x, 0);
    EXPECT_LE(vertex.atlas.x, 1);
  }
}

TEST(SceneLoad, MissingNormalsBecomeFlatAndUnshared) {
  SceneBuilder builder;
  const std::array<glm::vec3, 4> folded = {glm::vec3{-1, 0, 1}, {1, 0, 1}, {1, 1, -1}, {-1, 0, -1}};
  builder.quad("roof", folded, whole_chart, builder.material(glm::vec3(1)));
  const Scene scene = load_built(builder);
  ASSERT_EQ(scene.vertices.size(), 6u);
  for (std::size_t t = 0; t < 2; ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      expect_near(scene.vertices[scene.indices[3 * t + k]].normal, face_normal(scene, t));
  }
}

TEST(SceneLoad, NegativeScaleKeepsTheFrontInFront) {
  SceneBuilder builder;
  const int node = builder.quad("floor", floor_corners, whole_chart, builder.material(glm::vec3(1)));
  builder.node(node)["scale"] = {-2, 1, 1};
  const std::vector<glm::vec3> up(4, {0, 1, 0});
  builder.primitive(node)["attributes"]["NORMAL"] = builder.accessor(up, 5126, "VEC3");
  const Scene scene = load_built(builder);
  expect_near(face_normal(scene, 0), {0, 1, 0});
  expect_near(scene.vertices[0].normal, {0, 1, 0});
  EXPECT_EQ(scene.vertices.size(), 4u) << "vertices with normals stay shared";
  expect_near(scene.bodies[0].box.max, {2, 0, 1});
}

TEST(SceneLoad, NormalsFollowTheInverseTranspose) {
  SceneBuilder builder;
  const std::array<glm::vec3, 4> slope = {glm::vec3{-1, 0, 1}, {1, 0, 1}, {1, 2, -1}, {-1, 2, -1}};
  const int node = builder.quad("slope", slope, whole_chart, builder.material(glm::vec3(1)));
  builder.node(node)["scale"] = {1, 3, 1};
  const std::vector<glm::vec3> tilted(4, glm::normalize(glm::vec3(0, 1, 1)));
  builder.primitive(node)["attributes"]["NORMAL"] = builder.accessor(tilted, 5126, "VEC3");
  const Scene scene = load_built(builder);
  expect_near(scene.vertices[0].normal, face_normal(scene, 0));
}

TEST(SceneLoad, ParentsRotateAndMatricesApply) {
  SceneBuilder builder;
  const int child = builder.quad("child", floor_corners, whole_chart, builder.material(glm::vec3(1)));
  builder.node(child)["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1};  // x + 5
  builder.gltf["nodes"].push_back(
      {{"children", {child}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}});
  builder.gltf["scenes"][0]["nodes"] = {1};
  const Scene scene = load_built(builder);
  expect_near(face_normal(scene, 0), {-1, 0, 0});  // a quarter turn about z takes +y to -x
  expect_near(scene.bodies[0].box.min, {0, 4, -1});
}

TEST(SceneLoad, MovableInsideMovableBelongsToTheOuterOne) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(1));
  const int floor = builder.quad("floor", floor_corners, {0, 0, 0.4f, 0.4f}, grey);
  const int lid = builder.box("lid", glm::vec3(-1), glm::vec3(1), {0.5f, 0.5f, 1, 1}, grey);
  const int car = builder.box("car", glm::vec3(-1), glm::vec3(1), {0, 0.5f, 0.5f, 1}, grey);
  builder.set_movable(lid);
  builder.set_movable(car);
  builder.node(car)["translation"] = {0, 10, 0};
  builder.node(lid)["translation"] = {0, 3, 0};
  builder.node(car)["children"] = {lid};
  builder.gltf["scenes"][0]["nodes"] = {floor, car};
  const Scene scene = load_built(builder);
  ASSERT_EQ(scene.bodies.size(), 2u);
  EXPECT_EQ(scene.bodies[1].node, "car");
  expect_near(scene.bodies[1].place, {0, 10, 0});
  expect_near(scene.bodies[1].box.max, {1, 14, 1});
  EXPECT_EQ(find_body(scene, "car"), 1u);
  try {
    find_body(scene, "lid");
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("movable are: car"));
  }
}

TEST(SceneLoad, DoubleSidedSurfacesComeLast) {
  SceneBuilder builder;
  builder.quad("leaf", floor_corners, {0, 0, 0.4f, 0.4f}, builder.material(glm::vec3(1), {}, true));
  builder.quad("floor", floor_corners, {0.5f, 0.5f, 1, 1}, builder.material(glm::vec3(1)));
  const Scene scene = load_built(builder);
  EXPECT_EQ(scene.surfaces[0].node, "floor");
  EXPECT_EQ(scene.surfaces[1].node, "leaf");
  EXPECT_EQ(scene.one_sided_indices, scene.surfaces[1].first_index);
}

TEST(SceneLoad, StripsFansAndUnindexedListsFaceTheSameWay) {
  const std::vector<glm::vec2> atlas = {{0, 0.9f}, {0.9f, 0.9f}, {0.9f, 0}, {0, 0}};
  for (int mode : {5, 6}) {
    SceneBuilder builder;
    std::vector<glm::vec3> p(floor_corners.begin(), floor_corners.end());
    if (mode == 5) std::swap(p[2], p[3]);
    const int node = builder.mesh("floor", p, atlas, {}, builder.material(glm::vec3(1)));
    builder.primitive(node)["mode"] = mode;
    const Scene scene = load_built(builder);
    ASSERT_EQ(scene.indices.size(), 6u) << mode;
    for (std::size_t t = 0; t < 2; ++t) expect_near(face_normal(scene, t), {0, 1, 0});
  }
}

TEST(SceneLoad, NormalisedCoordinatesAndSmallIndices) {
  SceneBuilder builder;
  const int node = builder.quad("floor", floor_corners, whole_chart, builder.material(glm::vec3(1)));
  const std::vector<std::array<std::uint16_t, 2>> atlas = {{0, 65535}, {65535, 65535}, {65535, 0}, {0, 0}};
  auto& primitive = builder.primitive(node);
  const int coordinates = builder.accessor(atlas, 5123, "VEC2");
  builder.gltf["accessors"][static_cast<std::size_t>(coordinates)]["normalized"] = true;
  primitive["attributes"]["TEXCOORD_1"] = coordinates;
  primitive["indices"] = builder.accessor(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, 5121, "SCALAR");
  EXPECT_EQ(check_atlas(load_built(builder), 16), 256u);
}

TEST(SceneLoad, ZeroAreaTrianglesAreDropped) {
  SceneBuilder builder;
  builder.mesh("floor", {floor_corners.begin(), floor_corners.end()}, std::vector<glm::vec2>(4, {0.5f, 0.5f}),
               {0, 1, 2, 0, 0, 1, 1, 1, 1}, builder.material(glm::vec3(1)));
  EXPECT_EQ(load_built(builder).indices.size(), 3u);
}

TEST(SceneLoad, TexturesComeFromBufferViewsAndFilesBesideTheScene) {
  const std::string picture = text_of(testing::png);
  for (bool embedded : {true, false}) {
    SceneBuilder builder;
    const int material = builder.material(glm::vec3(1));
    const int node = builder.quad("floor", floor_corners, whole_chart, material);
    builder.primitive(node)["attributes"]["TEXCOORD_0"] = builder.primitive(node)["attributes"]["TEXCOORD_1"];
    builder.gltf["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    builder.gltf["textures"] = {{{"source", 0}}};
    if (embedded) {
      const int accessor = builder.accessor(std::vector<char>(picture.begin(), picture.end()), 5121, "SCALAR");
      builder.gltf["images"] = {
          {{"bufferView", builder.gltf["accessors"][static_cast<std::size_t>(accessor)]["bufferView"]},
           {"mimeType", "image/png"}}};
    } else {
      builder.gltf["images"] = {{{"uri", "picture.png"}}};
    }
    const TempFolder folder;
    folder.write("picture.png", picture);
    const Scene scene = load(folder.write("scene.glb", builder.glb()));
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.materials[0].texture, 0);
    EXPECT_EQ(scene.textures[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 10, 20, 30, 255}));
    EXPECT_EQ(scene.vertices[0].colour, scene.vertices[0].atlas);
  }
}

TEST(SceneLoad, BoundingSphereFollowsBodies) {
  SceneBuilder builder;
  const int cube =
      builder.box("cube", glm::vec3(-1), glm::vec3(1), {0, 0, 1, 1}, builder.material(glm::vec3(1)));
  builder.set_movable(cube);
  const Scene scene = load_built(builder);
  EXPECT_NEAR(bounding_sphere(scene).radius, std::sqrt(3.0f), 1e-6f);
  expect_near(bounding_sphere(scene, {{}, {3, 0, 0}}).centre, {3, 0, 0});
}

}  // namespace
}  // namespace lichtveld::scene
