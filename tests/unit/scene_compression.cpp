// Compressed geometry: what goes in comes out, and hostile streams take neither memory nor the process.
#include <gmock/gmock.h>

#include <random>

#include "lichtveld/scene/scene.hpp"
#include "scene_compressed.hpp"
#include "scene_damage.hpp"
#include "scene_log.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;
using testing::corners;
using testing::draco_extension;
using testing::encoded_floor;
using testing::meshopt;
using testing::pack;
using testing::packed_by_draco;
using testing::packed_by_meshopt;
using testing::view_json;

std::string glb(SceneBuilder builder) {
  testing::add_buffers(builder);
  return builder.glb();
}

void expect_the_floor(const Scene& scene) {
  ASSERT_EQ(scene.indices.size(), 6u);
  glm::vec3 low(9), high(-9);
  for (const std::uint32_t index : scene.indices) {
    const Vertex& vertex = scene.vertices[index];
    low = glm::min(low, vertex.position);
    high = glm::max(high, vertex.position);
    EXPECT_LT(glm::distance(vertex.normal, {0, 1, 0}), 1e-4f);
    EXPECT_LT(
        glm::distance(vertex.atlas, glm::vec2(0.5f) + 0.4f * glm::vec2(vertex.position.x, vertex.position.z)),
        1e-3f);
  }
  EXPECT_LT(glm::distance(low, {-1, 0, -1}) + glm::distance(high, {1, 0, 1}), 1e-3f);
}

Scene loaded_bytes(const std::string& bytes) {
  const TempFolder folder;
  return load(folder.write("scene.glb", bytes));
}

TEST(SceneCompression, MeshoptIsRead) {
  SceneBuilder builder = packed_by_meshopt();
  expect_the_floor(loaded_bytes(glb(builder)));

  std::vector<unsigned char> sequence(meshopt_encodeIndexSequenceBound(6, 4));
  sequence.resize(meshopt_encodeIndexSequence(sequence.data(), sequence.size(), corners.data(), 6));
  pack(builder, 2, sequence, "INDICES", 6, 2);
  expect_the_floor(loaded_bytes(glb(builder)));
}

TEST(SceneCompression, MeshoptFiltersAreUndone) {
  expect_the_floor(loaded_bytes(glb(testing::filtered_by_meshopt())));
}

TEST(SceneCompression, BadMeshoptIsRefused) {
  const auto extension = [](SceneBuilder& b, int accessor) -> json& {
    return view_json(b, accessor)["extensions"][meshopt];
  };
  const std::vector<SpoiltCase> cases = {
      {"Mode", [&](auto& b) { extension(b, 0)["mode"] = "MAGIC"; },
       "buffer view 0: EXT_meshopt_compression: unknown mode \"MAGIC\""},
      {"Filter", [&](auto& b) { extension(b, 0)["filter"] = "SEPIA"; }, "the filter SEPIA is not read"},
      {"FilterOfIndices", [&](auto& b) { extension(b, 2)["filter"] = "OCTAHEDRAL"; }, "ATTRIBUTES alone"},
      {"FilterStride", [&](auto& b) { extension(b, 0)["filter"] = "OCTAHEDRAL"; },
       "wants a byteStride of 4 or 8"},
      {"Stride", [&](auto& b) { extension(b, 0)["byteStride"] = 13; }, "byteStride 13 does not go"},
      {"StrideZero", [&](auto& b) { extension(b, 0)["byteStride"] = 0; }, "byteStride 0 does not go"},
      {"StrideOfIndices", [&](auto& b) { extension(b, 2)["byteStride"] = 12; }, "byteStride 12 does not go"},
      {"Part", [&](auto& b) { extension(b, 2)["count"] = 5; }, "no whole number of triangles"},
      {"None", [&](auto& b) { extension(b, 0)["count"] = 0; }, "no elements"},
      {"Negative", [&](auto& b) { extension(b, 0)["count"] = -1; }, "count is no whole number"},
      {"Huge", [&](auto& b) { extension(b, 0)["count"] = 2'000'000'000; }, "bytes cannot hold 24000000000"},
      {"Larger", [&](auto& b) { extension(b, 0)["count"] = 300; }, "its bytes do not decode"},
      {"Smaller", [&](auto& b) { extension(b, 0)["count"] = 3; }, "do not fit buffer view 0"},
      {"Outside", [&](auto& b) { extension(b, 0)["byteOffset"] = 1 << 20; }, "do not lie in buffer 0"},
      {"Buffer", [&](auto& b) { extension(b, 0)["buffer"] = 7; }, "there is no buffer 7"},
      {"Cut", [&](auto& b) { extension(b, 0)["byteLength"] = 20; }, "its bytes do not decode"},
      {"Triangles", [&](auto& b) { extension(b, 2)["byteLength"] = 3; }, "its bytes do not decode"}};
  for (const SpoiltCase& bad : cases) {
    SceneBuilder builder = packed_by_meshopt();
    bad.spoil(builder);
    EXPECT_THAT(error_of_bytes(glb(builder)), ::testing::HasSubstr(bad.message)) << bad.name;
  }
}

TEST(SceneCompression, DracoIsRead) {
  for (const auto method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
    SceneBuilder builder = packed_by_draco(encoded_floor(method));
    expect_the_floor(loaded(builder));
    // What is not in the stream is read as ever.
    attributes(builder)["NORMAL"] = builder.accessor(std::vector<glm::vec3>(4, {0, 1, 0}), 5126, "VEC3");
    expect_the_floor(loaded(builder));
  }
}

TEST(SceneCompression, BadDracoIsRefused) {
  const auto stream = encoded_floor(draco::MESH_EDGEBREAKER_ENCODING);
  const auto sequential = encoded_floor(draco::MESH_SEQUENTIAL_ENCODING);
  // The bytes from `at` on are others.
  const auto with = [](std::vector<unsigned char> bytes, std::size_t at, std::vector<unsigned char> others) {
    std::copy(others.begin(), others.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
    return packed_by_draco(bytes);
  };
  const auto refuses = [](SceneBuilder builder, const char* message) {
    EXPECT_THAT(error_of_bytes(builder.glb()), ::testing::HasSubstr(message)) << message;
  };
  const std::vector<unsigned char> most = {0xff, 0xff, 0xff, 0xff, 0x0f};
  refuses(with(stream, 0, {'d'}), "mesh 0, primitive 0: KHR_draco_mesh_compression: no Draco stream; undo");
  refuses(with(stream, 5, {1, 1}), "not of Draco's format 2.2");
  refuses(with(stream, 7, {0}), "no triangles");
  refuses(with(stream, 8, {9}), "an unknown way to encode triangles");
  refuses(with(stream, 13, most), "it has 4294967295 triangles");
  refuses(with(sequential, 11, most), "it has 4294967295 triangles");
  refuses(with(sequential, 12, most), "triangles, more than 4 million");
  for (std::size_t size = 0; size < stream.size(); ++size) {
    SceneBuilder builder =
        packed_by_draco({stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size)});
    EXPECT_NE(error_of_bytes(builder.glb()), "no error") << size;
  }
  const auto extension = [](SceneBuilder& b) -> json& { return b.primitive(0)["extensions"][draco_extension]; };
  expect_refused(
      packed_by_draco(stream),
      {{"View", [&](auto& b) { extension(b)["bufferView"] = 99; }, "there is no buffer view 99"},
       {"NoView", [&](auto& b) { extension(b).erase("bufferView"); }, "bufferView is no whole number"},
       {"NoAttributes", [&](auto& b) { extension(b).erase("attributes"); }, "has no attributes"},
       {"Id", [&](auto& b) { extension(b)["attributes"]["POSITION"] = 7; }, "POSITION: it has no attribute 7"},
       {"Accessor", [&](auto& b) { attributes(b)["POSITION"] = 77; }, "there is no accessor 77"}});
}

// Whatever is done to a stream, it is read or refused.
TEST(SceneCompression, DamagedStreams) {
  testing::LogCapture log;
  std::mt19937 random(1);
  const std::vector<std::string> files = {
      glb(packed_by_meshopt()), packed_by_draco(encoded_floor(draco::MESH_EDGEBREAKER_ENCODING)).glb(),
      packed_by_draco(encoded_floor(draco::MESH_SEQUENTIAL_ENCODING)).glb()};
  const TempFolder folder;
  for (int round = 0; round < 3000; ++round) {
    std::string bytes = files[static_cast<std::size_t>(round) % files.size()];
    const std::size_t data = bytes.find("BIN") + 4;
    for (std::size_t hits = 1 + random() % 3; hits > 0; --hits)
      if (random() % 3 > 0)  // in a stream, or in the JSON's numbers
        bytes[data + random() % (bytes.size() - data)] = static_cast<char>(random());
      else if (char& letter = bytes[random() % data]; letter >= '0' && letter <= '9')
        letter = static_cast<char>('0' + random() % 10);
    error_of(folder.write("damaged.glb", bytes));
  }
}

}  // namespace
}  // namespace lichtveld::scene
