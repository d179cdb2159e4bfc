// Accessors as exporters write them: sparse ones, and quantised ones.
#include <gmock/gmock.h>

#include "lichtveld/scene/scene.hpp"
#include "scene_damage.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;
using testing::make_sparse;
using testing::whole_numbers;

std::vector<glm::vec3> corners_of(const Scene& scene) {
  std::vector<glm::vec3> result;
  for (const std::uint32_t index : scene.indices) result.push_back(scene.vertices[index].position);
  return result;
}

TEST(SceneAccessors, SparsePartsReplaceElements) {
  SceneBuilder builder = sound();  // accessors: 0 POSITION, 1 TEXCOORD_1, 2 indices
  const glm::vec3 raised{1, 2, -1};
  make_sparse(builder, 0, std::vector<std::uint16_t>{0, 2}, std::vector<glm::vec3>{{-1, 0, 1}, raised});
  make_sparse(builder, 1, std::vector<std::uint32_t>{3}, std::vector<glm::vec2>{{0.2f, 0.3f}});
  make_sparse(builder, 2, std::vector<std::uint8_t>{1, 2, 4, 5}, std::vector<std::uint16_t>{2, 3, 1, 2});
  const Scene scene = loaded(builder);
  EXPECT_EQ(corners_of(scene), (std::vector<glm::vec3>{{-1, 0, 1},
                                                       raised,
                                                       {-1, 0, -1},  //
                                                       {-1, 0, 1},
                                                       {1, 0, 1},
                                                       raised}));
  EXPECT_EQ(scene.vertices[2].atlas, glm::vec2(0.2f, 0.3f));
}

TEST(SceneAccessors, WithoutABufferViewElementsAreZero) {
  SceneBuilder builder = sound();
  make_sparse(builder, 0, std::vector<std::uint16_t>{1, 2}, std::vector<glm::vec3>{{1, 0, 0}, {0, 1, 0}});
  accessor_json(builder, 0).erase("bufferView");
  const Scene scene = loaded(builder);  // of the two triangles one is left
  EXPECT_EQ(corners_of(scene), (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));

  attributes(builder)["NORMAL"] = builder.accessor(std::vector<glm::vec3>(4, {1, 0, 0}), 5126, "VEC3");
  const int normals = attributes(builder)["NORMAL"].get<int>();
  make_sparse(builder, normals, std::vector<std::uint8_t>{0, 1, 2, 3},
              std::vector<glm::vec3>(4, glm::vec3{0, 0, 5}));
  accessor_json(builder, normals).erase("bufferView");
  EXPECT_EQ(loaded(builder).vertices[0].normal, glm::vec3(0, 0, 1));
}

TEST(SceneAccessors, IndicesMayBeSparseAlone) {
  SceneBuilder builder = sound();
  make_sparse(builder, 2, std::vector<std::uint8_t>{1, 2}, std::vector<std::uint16_t>{1, 2});
  accessor_json(builder, 2).erase("bufferView");
  EXPECT_EQ(corners_of(loaded(builder)), (std::vector<glm::vec3>{{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}));
}

TEST(SceneAccessors, BadSparsePartsAreRefused) {
  SceneBuilder builder = sound();
  make_sparse(builder, 0, std::vector<std::uint16_t>{0, 2}, std::vector<glm::vec3>(2));
  const auto sparse = [](SceneBuilder& b) -> json& { return b.gltf["accessors"][0]["sparse"]; };
  const std::string what = "node \"floor\", primitive 0, POSITION (accessor 0), sparse part";
  expect_refused(
      builder,
      {{"MoreThanThere", [&](auto& b) { sparse(b)["count"] = 5; }, "sparse part: has 5 of 4 elements"},
       {"Negative", [&](auto& b) { sparse(b)["count"] = -1; }, "sparse part: has -1 of 4 elements"},
       {"Long", [&](auto& b) { sparse(b)["count"] = 3; }, "sparse part, indices: 3 elements"},
       {"Falls", [&](auto& b) { overwrite(b, 3, 1, std::uint16_t{0}); }, "its indices do not increase"},
       {"Outside", [&](auto& b) { overwrite(b, 3, 1, std::uint16_t{4}); }, "index 4 of 4 elements"},
       {"IndexType", [&](auto& b) { sparse(b)["indices"]["componentType"] = 5126; }, "expected indices of"},
       {"NoView", [&](auto& b) { sparse(b)["values"]["bufferView"] = 77; },
        "values: there is no buffer view 77"},
       {"NoIndices", [&](auto& b) { sparse(b).erase("indices"); }, "doesn't have indices"},
       {"Offset", [&](auto& b) { sparse(b)["values"]["byteOffset"] = 4; }, "values: 2 elements at offset 4"},
       {"OffsetBelow", [&](auto& b) { sparse(b)["indices"]["byteOffset"] = -2; }, "byteOffset"},
       {"Nan", [&](auto& b) { overwrite(b, 4, 3, std::nanf("")); }, "vertex 2 is not finite"},
       // No memory is taken for elements that are said to be zero.
       {"Endless",
        [&](auto& b) {
          b.gltf["accessors"][0].erase("bufferView");
          b.gltf["accessors"][0]["count"] = 1ull << 62;
          b.primitive(0).erase("indices");
        },
        "corners are no whole number"}});
  sparse(builder)["count"] = 5;
  EXPECT_THAT(error_of_bytes(builder.glb()), ::testing::HasSubstr(what));
}

TEST(SceneAccessors, QuantisedAttributesAreRead) {
  for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
    const Scene scene = loaded(testing::quantised(key));
    EXPECT_LT(glm::distance(scene.vertices[0].position, {-1, 0, 1}), 1e-6f);
    EXPECT_LT(glm::distance(scene.vertices[0].normal, glm::normalize(glm::vec3(0, 1, -1))), 1e-6f);
  }
}

TEST(SceneAccessors, NormalisedPositionsAreSharesOfTheLargest) {
  SceneBuilder builder = sound();
  const auto max16 = std::uint16_t{65535};
  attributes(builder)["POSITION"] = whole_numbers(
      builder, std::vector<std::array<std::uint16_t, 3>>{{0, 0, max16}, {max16, 0, max16}, {max16, 0, 0}, {}},
      5123, "VEC3", true);
  EXPECT_EQ(loaded(builder).vertices[1].position, glm::vec3(1, 0, 1));
  attributes(builder)["POSITION"] = whole_numbers(
      builder, std::vector<std::array<std::int8_t, 3>>{{-127, 0, 127}, {127, 0, 127}, {127, 0, -127}, {}}, 5120,
      "VEC3", true);
  EXPECT_EQ(loaded(builder).vertices[0].position, glm::vec3(-1, 0, 1));
}

TEST(SceneAccessors, WordsAreNoVectors) {
  expect_refused(sound(), {{"Ints",
                            [](auto& b) {
                              attributes(b)["POSITION"] =
                                  b.accessor(std::vector<std::array<std::uint32_t, 3>>(4), 5125, "VEC3");
                            },
                            "expected VEC3 of float, byte or short"},
                           {"Matrices",
                            [](auto& b) {
                              attributes(b)["POSITION"] =
                                  b.accessor(std::vector<std::array<float, 16>>(4), 5126, "MAT4");
                            },
                            "expected VEC3 of float, byte or short"}});
}

}  // namespace
}  // namespace lichtveld::scene
