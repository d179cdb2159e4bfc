// lichtveld bake --gltf: a scene and its light map for other programs.
#include <OpenImageIO/imagebuf.h>
#include <gmock/gmock.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "commands_run.hpp"
#include "hdr.hpp"
#include "scene_builder.hpp"

namespace lichtveld::testing {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Of a square map; a file's bytes say when it was written, too.
std::vector<float> pixels_of(const std::string& file, std::size_t size) {
  std::vector<float> pixels(4 * size * size, -1);
  EXPECT_TRUE(OIIO::ImageBuf(file).get_pixels(OIIO::ROI::All(), OIIO::TypeDesc::FLOAT, pixels.data())) << file;
  return pixels;
}

// The JSON of a .glb.
json read_glb(const std::filesystem::path& file) {
  const std::string bytes = bytes_of(file);
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, sizeof length);
  return json::parse(bytes.substr(20, length));
}

std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

class BakeGltf : public ::testing::Test {
 protected:
  // A floor under a lamp; nothing has TEXCOORD_1 but with `own`.
  static SceneBuilder plain(bool own = false) {
    SceneBuilder scene;
    const int grey = scene.material(glm::vec3(0.5f)), lamp = scene.material(glm::vec3(0), glm::vec3(5));
    const int floor = scene.quad("floor", {{{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}},
                                 {0.05f, 0.05f, 0.6f, 0.6f}, grey);
    const int light =
        scene.quad("lamp", {{{-0.5f, 1, -0.5f}, {0.5f, 1, -0.5f}, {0.5f, 1, 0.5f}, {-0.5f, 1, 0.5f}}},
                   {0.7f, 0.7f, 0.95f, 0.95f}, lamp);
    if (!own)
      for (const int node : {floor, light}) scene.primitive(node)["attributes"].erase("TEXCOORD_1");
    return scene;
  }

  Ran bake(const std::filesystem::path& scene, const std::string& options) const {
    return run("bake " + scene.string() + " --psf 8 --bounces 1 --out '" + path("E.exr") + "' --gltf " +
               path("lit.glb") + " " + options);
  }

  std::string path(const std::string& name) const { return (out_.path() / name).string(); }

  TempFolder in_, out_;
};

TEST_F(BakeGltf, NamesItsLightMapAndHasTheAtlasThatWasBaked) {
  const auto scene = in_.write("room.glb", plain().glb());
  const auto ran = run("bake " + scene.string() + " --size 32 --psf 8 --bounces 1 --out '" +
                       path("my light #1.exr") + "' --gltf " + path("lit.glb"));
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_THAT(names_in(out_.path()), UnorderedElementsAre("my light #1.exr", "lit.glb"));
  const json lit = read_glb(path("lit.glb"));
  EXPECT_EQ(lit["scenes"][0]["extras"]["lightMap"], "my%20light%20%231.exr");
  ASSERT_EQ(lit["meshes"].size(), 2u);
  for (const auto& mesh : lit["meshes"])
    EXPECT_TRUE(mesh["primitives"][0]["attributes"].contains("TEXCOORD_1")) << mesh;
  // With its atlas as it is, the file has the same light.
  const auto again =
      run("bake " + path("lit.glb") + " --keep-uv --size 32 --psf 8 --bounces 1 --out " + path("again.exr"));
  ASSERT_EQ(again.status, 0) << again.output;
  EXPECT_EQ(pixels_of(path("again.exr"), 32), pixels_of(path("my light #1.exr"), 32));
}

TEST_F(BakeGltf, ASceneKeepsItsOwnAtlasAndExtras) {
  auto builder = plain(true);
  builder.gltf["scenes"][0]["extras"] = {{"lightMap", "old.exr"}, {"sky", {1, 1, 1}}};
  const auto ran = bake(in_.write("room.glb", builder.glb()), "--size 32");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_THAT(ran.output, Not(HasSubstr("unwrapped")));
  const json lit = read_glb(path("lit.glb"));
  EXPECT_EQ(lit["scenes"][0]["extras"], (json{{"lightMap", "E.exr"}, {"sky", {1, 1, 1}}}));
  EXPECT_EQ(lit["meshes"].size(), 2u);
}

TEST_F(BakeGltf, AnAtlasThatHadToBeLargerIsBakedAsLarge) {
  // Loose triangles, each a chart of its own: 256 x 256 texels have no room for so many.
  constexpr std::uint16_t triangles = 9000;
  SceneBuilder builder;
  std::vector<glm::vec3> positions;
  std::vector<std::uint16_t> indices;
  for (std::uint16_t i = 0; i < triangles; ++i) {
    const glm::vec3 at(static_cast<float>(i % 100), 0, static_cast<float>(i / 100));
    for (const glm::vec3 corner : {glm::vec3(0), {0, 0, 0.5f}, {0.5f, 0, 0}}) positions.push_back(at + corner);
    for (std::uint16_t k = 0; k < 3; ++k) indices.push_back(static_cast<std::uint16_t>(3 * i + k));
  }
  const int grey = builder.material(glm::vec3(0.5f));
  const int loose = builder.mesh("loose", positions, std::vector<glm::vec2>(positions.size()), indices, grey);
  const int floor =
      builder.quad("floor", {{{0, -1, 100}, {100, -1, 100}, {100, -1, 0}, {0, -1, 0}}}, {0, 0, 1, 1}, grey);
  for (const int node : {loose, floor}) builder.primitive(node)["attributes"].erase("TEXCOORD_1");
  const auto scene = in_.write("room.glb", builder.glb());
  const std::string options = "--sky 1,1,1 --report " + path("r.json");
  const auto size = [&] { return json::parse(bytes_of(path("r.json")))["size"]; };
  auto ran = bake(scene, options);
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_EQ(size(), 512);
  ran = bake(scene, options + " --size 256");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_EQ(size(), 256) << "as it was asked";
  EXPECT_THAT(ran.output, AllOf(HasSubstr("warning"), HasSubstr("--size 512")));
}

TEST_F(BakeGltf, ASkyGoesBesideAndIsNeverWrittenOver) {
  auto builder = plain();
  builder.gltf["scenes"][0]["extras"]["sky"] = "sky.hdr";
  const auto scene = in_.write("room.glb", builder.glb());
  const auto sky = hdr(8, 4, [](int, int) { return glm::vec3(1); });
  in_.write("sky.hdr", sky);
  auto ran = bake(scene, "--size 32 --report " + path("sky.hdr"));
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.output, AllOf(HasSubstr("the scene's sky"), HasSubstr("--report"), HasSubstr("same file")));
  EXPECT_THAT(names_in(out_.path()), UnorderedElementsAre());
  ran = bake(scene, "--size 32");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_EQ(bytes_of(path("sky.hdr")), sky);
}

TEST_F(BakeGltf, WhatFailsWritesNothing) {
  const auto scene = in_.write("room.glb", plain().glb());
  const auto ran =
      run("bake " + scene.string() + " --size 32 --psf 8 --gltf " + path("lit.glb") + " --out " + path("E.exr"),
          "VK_ICD_FILENAMES=/nonexistent VK_DRIVER_FILES=/nonexistent");
  EXPECT_EQ(ran.status, 3) << ran.output;
  EXPECT_THAT(names_in(out_.path()), UnorderedElementsAre());
}

}  // namespace
}  // namespace lichtveld::testing
