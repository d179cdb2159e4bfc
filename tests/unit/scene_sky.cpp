// The sky: what is read of it, and what is wrong with it.
#include <gmock/gmock.h>

#include <numbers>

#include "hdr.hpp"
#include "lichtveld/scene/lights.hpp"
#include "lichtveld/scene/scene.hpp"
#include "scene_builder.hpp"
#include "scene_log.hpp"

namespace lichtveld::scene {
namespace {

using namespace lichtveld::testing;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double pi = std::numbers::pi;

class Skies : public ::testing::Test {
 protected:
  Skies() {
    builder_.quad("floor", {glm::vec3(-1, 0, 1), {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}, {0, 0, 1, 1},
                  builder_.material(glm::vec3(0.5f)));
  }

  Scene load(const std::string& sky = "") {
    return scene::load(folder_.write("scene.glb", builder_.glb()), {.sky = sky, .lights = lights_});
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  json& scene_json() { return builder_.gltf["scenes"][0]; }
  void refuses(const std::string& sky, const std::string& message) {
    EXPECT_THAT([&] { load(sky); }, ThrowsMessage<SceneError>(HasSubstr(message)));
  }

  TempFolder folder_;
  SceneBuilder builder_;
  std::vector<std::string> lights_;
};

TEST_F(Skies, AnEvenOneBringsPiTimesItsRadiance) {
  const auto scene = load("1,2,0.5");
  ASSERT_TRUE(scene.sky);
  EXPECT_NEAR(irradiance_of(*scene.sky).g, 2 * pi, 1e-5);
  EXPECT_EQ(radiance_of(*scene.sky, {0, 1, 0}), glm::vec3(1, 2, 0.5f));
  EXPECT_TRUE(has_light(scene));
}

TEST_F(Skies, APictureLiesAsThreeJsHasIt) {
  // Red up, green around +x, blue around +z.
  folder_.write("a.hdr", hdr(64, 32, [](int column, int row) {
                  if (row < 8) return glm::vec3(1, 0, 0);
                  if (column >= 24 && column < 40) return glm::vec3(0, 1, 0);
                  return column >= 40 && column < 56 ? glm::vec3(0, 0, 1) : glm::vec3(0);
                }));
  const auto sky = *load(path("a.hdr")).sky;
  EXPECT_EQ(radiance_of(sky, {0, 1, 0}), glm::vec3(1, 0, 0));
  EXPECT_EQ(radiance_of(sky, {1, 0, 0}), glm::vec3(0, 1, 0));
  EXPECT_EQ(radiance_of(sky, {0, 0, 1}), glm::vec3(0, 0, 1));
  EXPECT_EQ(radiance_of(sky, {-1, 0, 0}), glm::vec3(0));
  EXPECT_EQ(radiance_of(sky, {0, 0, -1}), glm::vec3(0));
  for (std::uint32_t row : {0u, 9u, 31u})
    EXPECT_EQ(radiance_of(sky, direction_of(sky, 30, row)), sky.radiance[row * 64 + 30]);
  float all = 0;
  for (std::uint32_t row = 0; row < 32; ++row) all += 64 * solid_angle_of(sky, row);
  EXPECT_NEAR(all, 4 * pi, 1e-4);
}

TEST_F(Skies, WhatIsFarBrighterBecomesASun) {
  const auto draw = [](bool with_sun) {
    return hdr(512, 256, [=](int column, int row) {
      const bool sun = with_sun && column >= 300 && column < 302 && row >= 60 && row < 62;
      return sun ? glm::vec3(8000, 7000, 6000) : glm::vec3(1);
    });
  };
  folder_.write("sun.hdr", draw(true));
  folder_.write("none.hdr", draw(false));
  const auto scene = load(path("sun.hdr")), without = load(path("none.hdr"));
  EXPECT_TRUE(without.punctual.empty());
  ASSERT_EQ(scene.punctual.size(), 1u);
  const auto& sun = scene.punctual[0];
  EXPECT_EQ(sun.kind, PunctualLight::Kind::directional);
  EXPECT_EQ(scene.sky->radiance, without.sky->radiance);
  const float solid_angle = 2 * solid_angle_of(*scene.sky, 60) + 2 * solid_angle_of(*scene.sky, 61);
  EXPECT_NEAR(sun.intensity.r / (solid_angle * 7999), 1, 0.01);
  const double rise = pi * (0.5 - 61.0 / 256), turn = 2 * pi * (301.0 / 512 - 0.5);
  EXPECT_NEAR(-sun.direction.y, std::sin(rise), 1e-3);
  EXPECT_NEAR(-sun.direction.x, std::cos(rise) * std::cos(turn), 1e-3);
  EXPECT_NEAR(-sun.direction.z, std::cos(rise) * std::sin(turn), 1e-3);
  EXPECT_NEAR(sun.angle, 1.4, 0.2) << "four pixels of 0.7 degrees";
}

TEST_F(Skies, AreNamedInTheScene) {
  scene_json()["extras"]["sky"] = {0.5, 1, 2};
  EXPECT_NEAR(irradiance_of(*load().sky).b, 2 * pi, 1e-5);
  EXPECT_NEAR(irradiance_of(*load("3,3,3").sky).b, 3 * pi, 1e-5) << "an option comes before the file";
  folder_.write("a.hdr", hdr(64, 32, [](int, int) { return glm::vec3(4); }));
  scene_json()["extras"]["sky"] = "a.hdr";
  EXPECT_NEAR(irradiance_of(*load().sky).b, 4 * pi, 1e-4);
}

TEST_F(Skies, OfTheExtensionHaveTheIrradianceThatItSays) {
  json coefficients(9, {0.0, 0.0, 0.0});
  coefficients[0] = {pi / 0.282095, 0, 0};  // E = pi everywhere
  coefficients[1] = {1 / 0.488603, 0, 0};   // and 1 more from above
  builder_.gltf["extensions"]["EXT_lights_image_based"]["lights"] = {
      {{"intensity", 2}, {"irradianceCoefficients", coefficients}}};
  builder_.gltf["extensionsRequired"] = {"EXT_lights_image_based"};
  scene_json()["extensions"]["EXT_lights_image_based"]["light"] = 0;
  EXPECT_NEAR(irradiance_of(*load().sky).r, 2 * (pi + 1), 0.01);
  EXPECT_NEAR(irradiance_of(*load().sky).g, 0, 1e-6);
  scene_json()["extensions"]["EXT_lights_image_based"]["light"] = 1;
  refuses("", "EXT_lights_image_based: there is no light 1");
  scene_json()["extensions"]["EXT_lights_image_based"]["light"] = 0;
  auto& light = builder_.gltf["extensions"]["EXT_lights_image_based"]["lights"][0];
  light["irradianceCoefficients"][3] = {1, 2};
  refuses("", "not three channels");
  light.erase("irradianceCoefficients");
  refuses("", "irradianceCoefficients are not nine");
}

TEST_F(Skies, ThatCannotBeAreRefused) {
  refuses("-1,0,0", "radiance must be 0..1e6");
  refuses("nan,0,0", "");
  refuses("1,1", "cannot be read");
  refuses(path("none.hdr"), "cannot be read");
  folder_.write("a.png", "\x89PNG, or so");
  refuses(path("a.png"), "neither Radiance .hdr nor OpenEXR");
  const auto good = hdr(64, 32, [](int, int) { return glm::vec3(1); });
  folder_.write("cut.hdr", good.substr(0, good.size() / 2));
  refuses(path("cut.hdr"), "does not decode");
  folder_.write("cut.exr", std::string("\x76\x2f\x31\x01\x02\0\0\0", 8));
  refuses(path("cut.exr"), "does not decode");
  // A text of 1.7 GB: no memory is taken for it.
  folder_.write("long.exr", std::string("\x76\x2f\x31\x01\x02\0\0\0comments\0string\0tion"
                                        "channels", 37));
  refuses(path("long.exr"), "its header says more than the file holds");
  folder_.write("square.hdr", hdr(32, 32, [](int, int) { return glm::vec3(1); }));
  refuses(path("square.hdr"), "twice as wide");
  folder_.write("vast.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 10000 +X 20000\n");
  refuses(path("vast.hdr"), "16384 x 8192 are read");
  scene_json()["extras"]["sky"] = "../a.hdr";
  refuses("", "leaves the scene's folder");
  scene_json()["extras"]["sky"] = true;
  refuses("", "extras.sky is neither");
}

TEST_F(Skies, SwitchWhereTheSceneSaysSo) {
  scene_json()["extras"] = {{"sky", {1, 1, 1}}, {"switchable", true}};
  const auto scene = load();
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(find_lights(scene, "sky"), std::vector<std::uint32_t>{1});
  EXPECT_EQ(scene.sky->light, 1u);
  EXPECT_NEAR(irradiance_of(*dimmed(scene, {glm::vec3(1), glm::vec3(0.5f)}).sky).r, pi / 2, 1e-5);
}

// A lamp of two nodes, one of which has a punctual light, and another that stays.
TEST_F(Skies, LightsAreWhatSwitchesTogether) {
  const int glow = builder_.material(glm::vec3(0), glm::vec3(2));
  const int shade = builder_.quad("shade", {glm::vec3(-1, 1, 1), {1, 1, 1}, {1, 1, -1}, {-1, 1, -1}},
                                  {0, 0, 0.1f, 0.1f}, glow);
  builder_.quad("other", {glm::vec3(-1, 2, 1), {1, 2, 1}, {1, 2, -1}, {-1, 2, -1}}, {0, 0.5f, 0.1f, 0.6f},
                glow);
  builder_.gltf["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 10}}};
  auto& nodes = builder_.gltf["nodes"];
  nodes.push_back({{"name", "bulb"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  nodes.push_back(
      {{"name", "lamp"}, {"children", {shade, nodes.size() - 1}}, {"extras", {{"switchable", true}}}});
  auto& roots = scene_json()["nodes"];
  roots.erase(std::find(roots.begin(), roots.end(), shade));
  roots.push_back(nodes.size() - 1);
  auto scene = load();
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[1].node, "lamp");
  EXPECT_EQ(scene.lights[1].place, glm::vec3(0, 0.5f, 0)) << "between the shade and the bulb";
  EXPECT_EQ(scene.punctual[0].light, 1u);
  const auto half = dimmed(scene, {glm::vec3(1), glm::vec3(0.5f)});
  for (const auto& surface : half.surfaces) {
    const auto& emission = half.materials[surface.material].emission;
    EXPECT_EQ(emission.r, surface.node == "shade"   ? 1.0f
                          : surface.node == "other" ? 2.0f
                                                    : 0.0f)
        << surface.node;
  }
  EXPECT_EQ(half.punctual[0].intensity.r, 5);
  EXPECT_THAT([&] { find_lights(scene, "other"); },
              ThrowsMessage<SceneError>(HasSubstr("there are: lamp, other")));
  lights_ = {"other"};
  scene = load();
  EXPECT_EQ(find_lights(scene, "other").size(), 1u) << "asked for by name";
}

TEST_F(Skies, WhatSwitchesAndDoesNotShineIsTold) {
  builder_.gltf["nodes"][0]["extras"]["switchable"] = true;
  LogCapture log;
  load();
  EXPECT_THAT(log.take(), HasSubstr("node \"floor\": is to be a light, and nothing of it shines"));
}

}  // namespace
}  // namespace lichtveld::scene
