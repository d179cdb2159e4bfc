// lichtveld check: the page, --json, --png, and what cannot be checked.
#include <OpenImageIO/imagebuf.h>
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "commands_run.hpp"
#include "scene_builder.hpp"

namespace lichtveld::testing {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Check : public ::testing::Test {
 protected:
  // A floor, a wall that shares texels with it, a lamp without a texel, and a point light.
  Check() {
    const int grey = builder_.material(glm::vec3(0.5f)), glow = builder_.material({}, glm::vec3(5));
    builder_.quad("floor", {glm::vec3(0, 0, 1), {1, 0, 1}, {1, 0, 0}, {0, 0, 0}}, {0, 0, 0.5f, 0.5f}, grey);
    builder_.quad("wall", {glm::vec3(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0.495f, 0.45f, 1, 1}, grey);
    builder_.quad("lamp", {glm::vec3(0, 1, 0), {0.1f, 1, 0}, {0.1f, 1, 0.1f}, {0, 1, 0.1f}},
                  {100.6f / 128, 20.6f / 128, 101.4f / 128, 21.4f / 128}, glow);
    builder_.gltf["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 683}}};
    builder_.gltf["nodes"].push_back({{"name", "bulb\u001b[2J"},
                                      {"translation", {0.5, 0.5, 0.5}},
                                      {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    builder_.gltf["scenes"][0]["nodes"].push_back(3);
    scene_ = write("scene.glb");
  }

  std::string write(const std::string& name) const { return folder_.write(name, builder_.glb()).string(); }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  Ran check(const std::string& options) const { return run("check " + scene_ + " --size 128 " + options); }
  // What is on stdout alone.
  json checked(const std::string& options) const {
    return json::parse(shell(std::string(LICHTVELD_BINARY) + " check " + scene_ + " --size 128 --json " +
                             options + " 2>/dev/null")
                           .output);
  }

  TempFolder folder_;
  SceneBuilder builder_;
  std::string scene_;
};

TEST_F(Check, IsAPage) {
  const auto ran = check("--no-trial");
  EXPECT_EQ(ran.status, 0) << ran.output;
  for (const char* words :
       {"triangles            6 in 3 surfaces, 2 materials, 0 textures", "the file's own TEXCOORD_1",
        "\"floor\" and \"wall\" share 6 texels", "1 of 3 charts hold no texel's centre",
        "-> bake with --size 256", "point \"bulb?[2J\": 8583 W", "surface \"lamp\": 0.1571 W",
        "not foretold: --no-trial"})
    EXPECT_THAT(ran.output, HasSubstr(words));
  EXPECT_THAT(ran.output, Not(HasSubstr("\x1b[2J"))) << "a file's names do nothing to a terminal";
  EXPECT_THAT(check("--no-trial --lumens-per-watt 683").output, HasSubstr("12.57 W (8583 lm)"));
}

TEST_F(Check, SaysHowFarOffABakeWouldBe) {
  const auto forecast = checked("").at("forecast");
  EXPECT_THAT(forecast["device"].get<std::string>(), HasSubstr("llvmpipe"));
  EXPECT_EQ(forecast["size"], 128);
  EXPECT_GT(forecast["seconds"].get<double>(), 0);
  EXPECT_GT(forecast["error"].get<double>(), 0);
  EXPECT_LT(forecast["error"].get<double>(), 1);
}

TEST_F(Check, WithoutADeviceItSaysSo) {
  const auto ran =
      run("check --size 128 " + scene_, "VK_ICD_FILENAMES=/nonexistent VK_DRIVER_FILES=/nonexistent");
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_THAT(ran.output, AllOf(HasSubstr("not foretold: no Vulkan device"), HasSubstr("share 6 texels")));
}

TEST_F(Check, IsAJsonObject) {
  const auto object = checked("--no-trial");
  EXPECT_EQ(object["geometry"]["triangles"], 6);
  EXPECT_EQ(object["atlas"]["source"], "file");
  EXPECT_EQ(object["atlas"]["shared_texels"], 6);
  EXPECT_EQ(object["atlas"]["shared"][0]["nodes"], json({"floor", "wall"}));
  EXPECT_EQ(object["atlas"]["charts_without_texel"], 1);
  EXPECT_EQ(object["atlas"]["texels_buried"], 0);
  EXPECT_TRUE(object["unwrapped"].is_null());
  EXPECT_TRUE(object["forecast"]["error"].is_null());
  EXPECT_EQ(object["forecast"]["why_not"], "--no-trial");
  EXPECT_EQ(object["lights"].size(), 2u);
  EXPECT_NEAR(object["lights"][1]["flux_w"][0].get<double>(), 0.1571, 1e-3);
  for (const auto& finding : object["findings"])
    for (const char* key : {"id", "severity", "count", "text", "advice"}) EXPECT_TRUE(finding.contains(key));
  // In a file it is the same, beside the page.
  const auto ran = check("--no-trial --json=" + path("check.json"));
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("what to change"));
  std::ifstream file(path("check.json"));
  EXPECT_EQ(json::parse(file), object);
}

TEST_F(Check, DrawsTheAtlas) {
  const auto ran = check("--no-trial --png " + path("atlas.png"));
  EXPECT_EQ(ran.status, 0) << ran.output;
  OIIO::ImageBuf image(path("atlas.png"));
  ASSERT_EQ(image.spec().width, 1024);
  ASSERT_EQ(image.spec().height, 1024);
  const auto at = [&](float column, float row) {  // [texels]
    std::array<float, 3> pixel{};
    image.getpixel(static_cast<int>(8 * column), static_cast<int>(8 * row), 0, pixel.data(), 3);
    return pixel;
  };
  const auto floor = at(10.5f, 10.5f), wall = at(100.5f, 100.5f), nothing = at(120.5f, 10.5f);
  EXPECT_EQ(at(50.5f, 50.5f), floor);
  EXPECT_NE(floor, wall);
  EXPECT_NE(floor, nothing);
  EXPECT_LT(nothing[0], 0.2f);
  EXPECT_EQ(at(63.5f, 60.5f), (std::array{1.0f, 0.0f, 0.0f})) << "shared";
  EXPECT_EQ(at(62.5f, 60.5f), floor);
  // The lamp's chart: a frame about its middle.
  int white = 0;
  for (int y = 168 - 4; y <= 168 + 4; ++y)
    for (int x = 808 - 4; x <= 808 + 4; ++x) {
      std::array<float, 3> pixel{};
      image.getpixel(x, y, 0, pixel.data(), 3);
      white += pixel == std::array{1.0f, 1.0f, 1.0f};
    }
  EXPECT_EQ(white, 16);
}

TEST_F(Check, WhatCannotBeIsRefusedWithAdvice) {
  const auto refused = [&](const std::string& arguments, const std::string& message) {
    const auto ran = run("check " + arguments);
    EXPECT_EQ(ran.status, 2) << arguments << ran.output;
    EXPECT_THAT(ran.output, HasSubstr(message));
  };
  refused("", "scene");
  refused(path("nowhere.glb"), "no such file");
  refused(scene_ + " --size 8", "--size 8: texels a side, 16..4096");
  refused(scene_ + " --png " + path("atlas.jpg"), ".png");
  refused(scene_ + " --png " + path("nowhere/atlas.png"), "nowhere");
  refused(scene_ + " --json=" + scene_, "scene");
  refused(scene_ + " --png " + path("a.png") + " --json=" + path("a.png"), "a.png");
  refused(scene_ + " --lumens-per-watt 0", "--lumens-per-watt: a number above 0");
  const std::filesystem::directory_iterator files(folder_.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1) << "nothing is written";
}

// What extras hold costs no more than their text does.
TEST_F(Check, ExtrasOfManyNumbersTakeLittleMemory) {
  constexpr std::size_t text = 32u << 20;
  std::string zeros = "[0";
  while (zeros.size() < text) zeros += ",0";
  for (const bool own : {true, false}) {
    builder_.node(0)["extras"] = {{"zeros", "@"}};
    if (!own) builder_.primitive(0)["attributes"].erase("TEXCOORD_1");
    // A .gltf with its buffer beside it, as the text is put in by hand.
    folder_.write("scene.bin", builder_.bin);
    auto gltf = builder_.gltf;
    gltf["buffers"] = {{{"byteLength", builder_.bin.size()}, {"uri", "scene.bin"}}};
    std::string json_text = gltf.dump();
    json_text.replace(json_text.find("\"@\""), 3, zeros + "]");
    const auto ran = run("check --no-trial " + folder_.write("zeros.gltf", json_text).string());
    EXPECT_EQ(ran.status, 0) << ran.output;
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    EXPECT_LT(static_cast<std::size_t>(usage.ru_maxrss) << 10, 10 * text) << (own ? "" : "unwrapped");
  }
}

TEST(Unwrap, OfASceneWithoutTrianglesIsRefused) {
  const TempFolder folder;
  SceneBuilder builder;
  builder.gltf["nodes"] = {{{"name", "empty"}}};
  builder.gltf["scenes"][0]["nodes"] = {0};
  const auto scene = folder.write("empty.gltf", builder.gltf.dump()).string();
  for (const std::string& command :
       {"unwrap " + scene + " --out " + (folder.path() / "o.glb").string(),
        "bake " + scene + " --out " + (folder.path() / "o.exr").string(), "check " + scene, "info " + scene}) {
    const auto ran = run(command);
    EXPECT_EQ(ran.status, 2) << command << ran.output;
    EXPECT_THAT(ran.output, HasSubstr("has no triangles with an area")) << command;
  }
  const std::filesystem::directory_iterator files(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

}  // namespace
}  // namespace lichtveld::testing
