// Light from outside: against what it must bring, and the reference.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "device_for_tests.hpp"
#include "hdr.hpp"
#include "known_scenes.hpp"
#include "lichtveld/reference/path_tracer.hpp"
#include "lichtveld/scene/lights.hpp"
#include "light_fields.hpp"
#include "texels.hpp"

namespace lichtveld::lightfield {
namespace {

using namespace lichtveld::testing;

scene::Scene under_sky(const SceneBuilder& builder, const std::string& picture) {
  const TempFolder folder;
  const auto sky = folder.write("sky.hdr", picture);
  return scene::load(folder.write("scene.glb", builder.glb()), {.sky = sky.string(), .lights = {}});
}

scene::Scene under_sky(const SceneBuilder& builder, const glm::vec3& radiance) {
  auto scene = loaded(builder);
  scene.sky = scene::Sky{.radiance = {radiance}};
  return scene;
}

class Sky : public WithDevice {
 protected:
  std::vector<glm::vec4> irradiance(const scene::Scene& scene, const Settings& settings,
                                    const std::string& engine = "rays") {
    const auto light = make_light_field(engine, device(), scene, settings);
    settled(*light, at_rest(scene));
    return light->irradiance();
  }
  Texels of_node(const scene::Scene& scene, const Settings& settings, const std::string& node,
                 const std::string& engine = "rays") {
    return of(texels(scene, settings.size, irradiance(scene, settings, engine), {}), node);
  }
};

TEST_F(Sky, OpenGroundUnderAnEvenOneHasPi) {
  SceneBuilder builder;
  square(builder, "ground", 0, false, chart_a, builder.material(glm::vec3(0.5f)));
  const auto scene = under_sky(builder, glm::vec3(1, 2, 0));
  for (const std::string engine : {"rays", "links", "thesis"})
    for (const auto& texel : of_node(scene, {.size = 32, .psf = 24}, "ground", engine)) {
      ASSERT_NEAR(texel.irradiance.r, pi, 1e-4) << engine;
      ASSERT_NEAR(texel.irradiance.g, 2 * pi, 1e-4) << engine;
      ASSERT_EQ(texel.irradiance.b, 0) << engine;
    }
}

TEST_F(Sky, APictureBringsWhatItHolds) {
  // Brighter towards the zenith, and blue in one quarter.
  const auto picture = hdr(256, 128, [](int column, int row) {
    const float up = std::max(std::sin(3.14159265f * (0.5f - (static_cast<float>(row) + 0.5f) / 128)), 0.0f);
    return glm::vec3(0.2f + up, 0.2f + up * up, column >= 128 && column < 192 ? 3.0f : 0.5f);
  });
  // A square each that looks along y, and along x.
  const std::array<std::array<glm::vec3, 4>, 2> squares = {
      {{glm::vec3(-1, 0, 1), {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}},
       {glm::vec3(0, -1, 1), {0, -1, -1}, {0, 1, -1}, {0, 1, 1}}}};
  for (const auto& corners : squares) {
    SceneBuilder builder;
    builder.quad("square", corners, chart_a, builder.material(glm::vec3(0.5f)));
    const auto scene = under_sky(builder, picture);
    EXPECT_TRUE(scene.punctual.empty());
    const glm::vec3 normal = scene.vertices[0].normal;
    glm::dvec3 expected(0);
    for (std::uint32_t row = 0; row < 128; ++row)
      for (std::uint32_t column = 0; column < 256; ++column)
        expected += double{scene::solid_angle_of(*scene.sky, row)} *
                    double{std::max(glm::dot(scene::direction_of(*scene.sky, column, row), normal), 0.0f)} *
                    glm::dvec3(scene.sky->radiance[row * 256 + column]);
    for (const std::string engine : {"rays", "links"})
      for (const auto& texel : of_node(scene, {.size = 32, .psf = 24, .bounces = 1}, "square", engine))
        for (int channel = 0; channel < 3; ++channel)
          ASSERT_NEAR(texel.irradiance[channel] / expected[channel], 1, 0.01) << engine << channel;
  }
}

// A room whose wall at x = 2 has a window of 1.2 m, and a box in it.
SceneBuilder room_with_window(bool movable) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.6f)), red = builder.material(glm::vec3(0.6f, 0.2f, 0.2f));
  const auto cell = [](int i) {
    const float u = static_cast<float>(i % 4) / 4, v = static_cast<float>(i / 4) / 4;
    return Chart{u + 1.f / 64, v + 1.f / 64, u + 15.f / 64, v + 15.f / 64};
  };
  square(builder, "floor", 0, false, cell(0), grey, 2);
  square(builder, "ceiling", 3, true, cell(1), grey, 2);
  builder.quad("left", {glm::vec3(-2, 0, 2), {-2, 0, -2}, {-2, 3, -2}, {-2, 3, 2}}, cell(2), red);
  builder.quad("back", {glm::vec3(-2, 0, -2), {2, 0, -2}, {2, 3, -2}, {-2, 3, -2}}, cell(3), grey);
  builder.quad("front", {glm::vec3(2, 0, 2), {-2, 0, 2}, {-2, 3, 2}, {2, 3, 2}}, cell(4), grey);
  const auto pane = [&](const char* name, float y0, float y1, float z0, float z1, int i) {
    builder.quad(name, {glm::vec3(2, y0, z0), {2, y0, z1}, {2, y1, z1}, {2, y1, z0}}, cell(i), grey);
  };
  pane("below", 0, 1, -2, 2, 5);
  pane("above", 2.2f, 3, -2, 2, 6);
  pane("before", 1, 2.2f, -2, -0.6f, 7);
  pane("behind", 1, 2.2f, 0.6f, 2, 8);
  const int box = builder.box("box", {-0.5f, 0, -1.5f}, {0.5f, 1, -0.5f}, {0.25f, 0.5f, 0.75f, 0.8125f}, grey);
  if (movable) builder.set_movable(box);
  return builder;
}

struct Error {
  double rel_rmse, bias;
};

// Against two traced maps whose noise has nothing to do with each other, so that it adds nothing on average.
Error error_of(const std::vector<glm::vec4>& map, const scene::Scene& scene, std::uint32_t size,
               std::uint32_t spp) {
  const auto a = reference::trace(scene, {}, {.size = size, .spp = spp, .seed = 1}),
             b = reference::trace(scene, {}, {.size = size, .spp = spp, .seed = 2});
  double squares = 0, sum = 0, truth = 0;
  for (std::size_t i = 0; i < map.size(); ++i)
    for (int channel = 0; channel < 3 && map[i].a > 0; ++channel) {
      const double from_a = double{map[i][channel]} - a.texels[i][channel],
                   from_b = double{map[i][channel]} - b.texels[i][channel];
      squares += from_a * from_b;
      sum += (from_a + from_b) / 2;
      truth += (double{a.texels[i][channel]} + b.texels[i][channel]) / 2;
    }
  const auto count = 3.0 * static_cast<double>(std::ranges::count_if(map, [](auto& e) { return e.a > 0; }));
  return {std::sqrt(std::max(squares / count, 0.0)) / (truth / count), sum / truth};
}

TEST_F(Sky, AWindowIsRightToThreePercent) {
  const auto scene = under_sky(room_with_window(false), glm::vec3(1));
  const auto [rel_rmse, bias] = error_of(irradiance(scene, {.size = 128, .psf = 96}), scene, 128, 512);
  EXPECT_LT(rel_rmse, 0.03);
  EXPECT_LT(std::abs(bias), 0.007) << "0.2 % at the 256 texels of the default";
}

TEST_F(Sky, WhatMovesUnderItIsAsFresh) {
  const auto scene = under_sky(room_with_window(true), glm::vec3(1));
  const Settings settings{.size = 64, .psf = 96, .bounces = 2};
  const auto rays = make_light_field("rays", device(), scene, settings);
  settled(*rays, at_rest(scene));
  auto moved = at_rest(scene);
  moved[1] = {0.8f, 0.4f, 0.9f};
  settled(*rays, moved);
  const auto fresh = make_light_field("rays", device(), scene, settings);
  settled(*fresh, moved);
  EXPECT_EQ(rays->irradiance(), fresh->irradiance());
}

TEST_F(Sky, TheReferenceHasPi) {
  SceneBuilder builder;
  square(builder, "ground", 0, false, chart_a, builder.material(glm::vec3(0.5f)));
  const auto scene = under_sky(builder, glm::vec3(1));
  const auto traced = reference::trace(scene, {}, {.size = 16, .spp = 16});
  for (const auto& texel : texels(scene, 16, traced.texels, {})) ASSERT_NEAR(texel.irradiance.r, pi, 1e-4);
}

}  // namespace
}  // namespace lichtveld::lightfield
