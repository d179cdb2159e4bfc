// What the command line says of lights: --light, --sky, --lumens-per-watt, --lights-apart.
#include <OpenImageIO/imagebuf.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "commands_run.hpp"
#include "hdr.hpp"
#include "scene_builder.hpp"

namespace lichtveld::testing {
namespace {

using ::testing::HasSubstr;

class BakeLights : public ::testing::Test {
 protected:
  // A floor under two lamps of one material, the first of which switches, and a point of 683.
  BakeLights() {
    const int grey = builder_.material(glm::vec3(0.5f)), glow = builder_.material(glm::vec3(0), glm::vec3(4));
    builder_.quad("floor", {glm::vec3(-1, 0, 1), {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}, {0, 0, 0.5f, 1}, grey);
    builder_.set_movable(
        builder_.box("box", {-0.2f, 0.3f, -0.2f}, {0.2f, 0.6f, 0.2f}, {0.5f, 0.5f, 1, 1}, grey));
    const auto lamp = [&](const char* name, float x, Chart chart) {
      return builder_.quad(
          name, {glm::vec3(x, 2, -0.1f), {x + 0.2f, 2, -0.1f}, {x + 0.2f, 2, 0.1f}, {x, 2, 0.1f}}, chart, glow);
    };
    const int first = lamp("lamp", -0.6f, {0.55f, 0.05f, 0.7f, 0.2f});
    lamp("other", 0.4f, {0.75f, 0.05f, 0.9f, 0.2f});
    auto& nodes = builder_.gltf["nodes"];
    nodes[static_cast<std::size_t>(first)]["extras"]["switchable"] = true;
    builder_.gltf["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 683}}};
    nodes.push_back({{"name", "bulb"},
                     {"translation", {0, 3, 0}},
                     {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    builder_.gltf["scenes"][0]["nodes"].push_back(nodes.size() - 1);
    scene_ = folder_.write("scene.glb", builder_.glb()).string();
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  Ran bake(const std::string& options) {
    // Another name each time: OpenImageIO keeps what it has read.
    out_ = std::string(++bakes_, 'E') + ".exr";
    return run("bake " + scene_ + " --validation --size 64 --out " + path(out_) + " " + options);
  }
  std::vector<float> values(const std::string& name) const {
    OIIO::ImageBuf image(path(name));
    std::vector<float> all(64 * 64 * 4);
    EXPECT_TRUE(image.get_pixels(OIIO::ROI::All(), OIIO::TypeDesc::FLOAT, all.data())) << name;
    return all;
  }
  std::vector<float> baked(const std::string& options) {
    const auto ran = bake(options);
    EXPECT_EQ(ran.status, 0) << ran.output;
    return values(out_);
  }
  // rel_rmse, texels and channels together.
  static double difference(const std::vector<float>& a, const std::vector<float>& b) {
    double squares = 0, sum = 0, count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (i % 4 == 3 || b[i / 4 * 4 + 3] == 0) continue;
      squares += std::pow(double{a[i]} - b[i], 2), sum += b[i], ++count;
    }
    return std::sqrt(squares / count) / (sum / count);
  }

  TempFolder folder_;
  SceneBuilder builder_;
  std::string scene_, out_;
  std::size_t bakes_ = 0;
};

TEST_F(BakeLights, ThoseThatAreDimmedAreAsBrightAsAsked) {
  const auto all = baked("");
  const auto dim = baked("--light lamp=0.5 --light bulb=0 --light other=1,0,2");
  EXPECT_GT(difference(dim, all), 0.3);
  const auto live = baked("--live --move box=0.1,0,0 --light lamp=0.5 --light bulb=0 --light other=1,0,2");
  const auto moved = baked("--move box=0.1,0,0 --light lamp=0.5 --light bulb=0 --light other=1,0,2");
  EXPECT_LT(difference(live, moved), 2e-3);
  const auto truth = baked(
      "--method reference --spp 256 --move box=0.1,0,0 --light lamp=0.5 --light bulb=0 --light other=1,0,2");
  EXPECT_LT(difference(moved, truth), 0.05);
  const auto thesis = baked("--method thesis --direct exact --psf 96 --light bulb=0");
  EXPECT_LT(difference(thesis, baked("--light bulb=0")), 0.1);
}

TEST_F(BakeLights, EachAloneAddUpToAll) {
  const auto all = baked("--light other=0.25 --lights-apart " + path("apart"));
  std::vector<float> sum(all.size(), 0);
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path("apart"))) {
    names.push_back(entry.path().filename().string());
    const auto part = values("apart/" + names.back());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
  }
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("rest.exr", "lamp.exr", "other.exr"));
  EXPECT_LT(difference(sum, all), 1e-5);
}

TEST_F(BakeLights, LumensAreDividedByWhatAWattHas) {
  const auto only = "--light lamp=0 --light other=0 --bounces 1 ";
  auto expected = baked(only);
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (i % 4 != 3) expected[i] /= 683;
  EXPECT_LT(difference(baked(std::string(only) + "--lumens-per-watt 683"), expected), 1e-5);
}

TEST_F(BakeLights, ASkyIsOneRadianceOrAPicture) {
  const auto even = baked("--sky 0.5,0.5,0.5");
  folder_.write("sky.hdr", hdr(64, 32, [](int, int) { return glm::vec3(0.5f); }));
  EXPECT_LT(difference(baked("--sky " + path("sky.hdr")), even), 5e-3);
  EXPECT_GT(difference(baked(""), even), 0.02);
  EXPECT_LT(difference(baked("--sky 1,1,1 --light sky=0.5"), even), 1e-5);
}

TEST_F(BakeLights, WhatCannotBeIsRefusedWithAdvice) {
  const auto refused = [&](const std::string& options, const std::string& message) {
    const auto ran = bake(options);
    EXPECT_EQ(ran.status, 2) << options;
    EXPECT_THAT(ran.output, HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(path(out_))) << options;
  };
  refused("--light lamp", "--light lamp: write NAME=SCALE or NAME=R,G,B");
  refused("--light lamp=-1", "write NAME=SCALE");
  refused("--light lamp=1,2", "write NAME=SCALE");
  refused("--light lamp=nan", "write NAME=SCALE");
  refused("--light sun=1", "nothing that shines is called \"sun\"; there are: bulb, lamp, other");
  refused("--light floor=1 --light floor=2", "");
  refused("--sky nowhere.hdr", "it cannot be read");
  refused("--sky -1,0,0", "radiance must be 0..1e6");
  refused("--lumens-per-watt 0", "--lumens-per-watt: a number above 0");
  refused("--live --lights-apart " + path("apart"), "--lights-apart");
  refused("--direct psf", "has no surface that directions could find");
  refused("--method reference --lights-apart " + path("apart"),
          "--lights-apart means nothing to --method reference");
}

}  // namespace
}  // namespace lichtveld::testing
