// Punctual lights: against what they must bring, and the reference.
#include <gmock/gmock.h>

#include <cmath>

#include "device_for_tests.hpp"
#include "known_scenes.hpp"
#include "lichtveld/reference/error.hpp"
#include "lichtveld/reference/path_tracer.hpp"
#include "lichtveld/scene/lights.hpp"
#include "light_fields.hpp"
#include "texels.hpp"

namespace lichtveld::lightfield {
namespace {

using namespace lichtveld::testing;
using nlohmann::json;
using scene::Offsets;

// A node with a light there.
int add_light(SceneBuilder& builder, const glm::vec3& place, const json& light) {
  auto& lights = builder.gltf["extensions"]["KHR_lights_punctual"]["lights"];
  lights.push_back(light);
  json node = {{"name", "light"},
               {"translation", {place.x, place.y, place.z}},
               {"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}};
  auto& nodes = builder.gltf["nodes"];
  nodes.push_back(node);
  builder.gltf["scenes"][0]["nodes"].push_back(nodes.size() - 1);
  return static_cast<int>(nodes.size()) - 1;
}

// A quarter turn about x: what looks along -z looks down.
const json downwards = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};

class PunctualLights : public WithDevice {
 protected:
  // The square |x|, |z| <= 1 at y = 0, lit straight by one light.
  Texels floor(const glm::vec3& place, const json& light, const std::string& engine = "rays",
               const json& rotation = downwards) {
    SceneBuilder builder;
    square(builder, "floor", 0, false, chart_a, builder.material(glm::vec3(0.5f)));
    const int node = add_light(builder, place, light);
    builder.gltf["nodes"][static_cast<std::size_t>(node)]["rotation"] = rotation;
    const auto scene = loaded(builder);
    return of(texels_of(scene, {.size = 32, .psf = 24, .bounces = 1}, engine), "floor");
  }
  Texels texels_of(const scene::Scene& scene, const Settings& settings, const std::string& engine = "rays") {
    const auto light = make_light_field(engine, device(), scene, settings);
    settled(*light, at_rest(scene));
    return texels(scene, settings.size, light->irradiance(), {});
  }
};

TEST_F(PunctualLights, APointFallsWithTheSquareOfItsDistance) {
  for (const std::string engine : {"rays", "links", "thesis"})
    for (const auto& texel : floor({0.3f, 2, 0}, {{"type", "point"}, {"intensity", 100}}, engine)) {
      const double squared =
          glm::dot(texel.position - glm::dvec3(0.3, 2, 0), texel.position - glm::dvec3(0.3, 2, 0));
      ASSERT_NEAR(texel.irradiance.g / (100 * 2 / std::pow(squared, 1.5)), 1, 1e-3) << engine;
    }
}

TEST_F(PunctualLights, TheSunIsTheSameEverywhere) {
  for (const auto& texel :
       floor({0, 9, 0}, {{"type", "directional"}, {"intensity", 3}, {"color", {1, 0.5, 0}}})) {
    ASSERT_NEAR(texel.irradiance.r, 3, 1e-3);
    ASSERT_NEAR(texel.irradiance.g, 1.5, 1e-3);
    ASSERT_EQ(texel.irradiance.b, 0);
  }
  const double slanted = std::cos(std::atan(1.0));
  for (const auto& texel : floor({0, 9, 0}, {{"type", "directional"}, {"intensity", 3}}, "rays",
                                 {-std::sin(std::atan(1.0) / 2), 0, 0, std::cos(std::atan(1.0) / 2)}))
    ASSERT_NEAR(texel.irradiance.g, 3 * slanted, 1e-3);
}

TEST_F(PunctualLights, ASpotEndsAtItsCone) {
  const json spot = {
      {"type", "spot"}, {"intensity", 10}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}}}};
  int full = 0, none = 0;
  for (const auto& texel : floor({0, 2, 0}, spot)) {
    const double away = std::hypot(texel.position.x, texel.position.z), angle = std::atan2(away, 2);
    if (angle < 0.199) {
      ASSERT_NEAR(texel.irradiance.g / (10 * 2 / std::pow(4 + away * away, 1.5)), 1, 1e-3);
      ++full;
    } else if (angle > 0.401) {
      ASSERT_EQ(texel.irradiance.g, 0);
      ++none;
    }
  }
  EXPECT_GT(full, 10);
  EXPECT_GT(none, 10);
}

TEST_F(PunctualLights, NothingArrivesBeyondTheirRange) {
  for (const auto& texel : floor({0, 2, 0}, {{"type", "point"}, {"intensity", 10}, {"range", 1.9}}))
    ASSERT_EQ(texel.irradiance.g, 0);
}

// A room with all of them, hard and soft, and a lamp with a surface.
scene::Scene room(bool movable) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.6f));
  builder.box("room", {-2, 0, -2}, {2, 3, 2}, {0, 0, 1, 0.5f}, grey, true);
  builder.box("block", {-1.3f, 0, -1}, {-0.3f, 1, 0}, {0.125f, 0.5f, 0.5f, 0.75f}, grey);
  builder.set_movable(
      builder.box("a", {0.3f, 0.3f, 0.2f}, {0.9f, 0.9f, 0.8f}, {0.5f, 0.5f, 0.875f, 0.75f}, grey));
  square(builder, "lamp", 2.9f, true, {0, 0.5f, 0.1f, 0.6f}, builder.material(glm::vec3(0), glm::vec3(5)),
         0.2f);
  const int point =
      add_light(builder, {-1, 2, 1}, {{"type", "point"}, {"intensity", 2}, {"extras", {{"radius", 0.1}}}});
  if (movable) builder.set_movable(point);
  add_light(builder, {1, 1.5f, 1.5f},
            {{"type", "spot"}, {"intensity", 3}, {"spot", {{"outerConeAngle", 0.7}}}});
  return loaded(builder);
}

TEST_F(PunctualLights, AgreeWithTheReference) {
  const auto scene = room(false);
  const auto truth = reference::trace(scene, {}, {.size = 128, .spp = 512});
  for (const std::string engine : {"rays", "links"}) {
    const auto light =
        make_light_field(engine, device(), scene, {.size = 128, .psf = engine == "rays" ? 96u : 384u});
    settled(*light, at_rest(scene));
    const auto error = reference::error_of(light->irradiance(), truth.texels);
    EXPECT_LT(error.rel_rmse, 0.03) << engine;
    EXPECT_LT(std::abs(error.bias), 0.005) << engine;
  }
}

TEST_F(PunctualLights, OneThatIsCarriedTakesItsLightAlong) {
  const auto scene = room(true);
  const Settings settings{.size = 64, .psf = 96, .bounces = 2};
  const auto rays = make_light_field("rays", device(), scene, settings);
  settled(*rays, at_rest(scene));
  Offsets moved = at_rest(scene);
  ASSERT_EQ(moved.size(), 3u);
  moved[1] = {0.1f, 0.2f, -0.3f};
  moved[2] = {0.7f, -0.2f, -0.4f};
  settled(*rays, moved);
  const auto fresh = make_light_field("rays", device(), scene, settings);
  settled(*fresh, moved);
  EXPECT_EQ(rays->irradiance(), fresh->irradiance());
}

// The map after a move has such light roughly; when nothing moves any more it is as if found afresh.
TEST_F(PunctualLights, WhileTheyMoveTheyAreRoughAndThenWhole) {
  auto scene = room(true);
  scene.sky = scene::Sky{.radiance = {glm::vec3(0.5f)}};
  const Settings settings{.size = 64, .psf = 96};
  const auto rays = make_light_field("rays", device(), scene, settings);
  rays->settle();
  Offsets moved = at_rest(scene);
  for (const float way : {0.1f, 0.2f, 0.3f}) {
    moved[1] = {way, 0.1f, -way};
    moved[2] = {2 * way, -way, -way};
    rays->place(moved);
    rays->step([](std::uint32_t) { return true; });
  }
  const auto rough = rays->irradiance();
  rays->settle();
  const auto fresh = make_light_field("rays", device(), scene, settings);
  fresh->place(moved);
  fresh->settle();
  EXPECT_LT(reference::error_of(rough, fresh->irradiance()).rel_rmse, 0.25) << "a bounce behind, too";
  EXPECT_GT(reference::error_of(rough, fresh->irradiance()).rel_rmse, 0.001);
  EXPECT_LT(reference::error_of(rays->irradiance(), fresh->irradiance()).rel_rmse, 2e-3);
}

TEST_F(PunctualLights, HaveNoSurfaceThatDirectionsFind) {
  EXPECT_THROW(make_light_field("links", device(), room(false), {.size = 32, .direct = Direct::psf}),
               std::invalid_argument);
}

// Two lamps of one material and a point that switch, and a lamp that does not.
scene::Scene room_of_lights() {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.6f)), glow = builder.material(glm::vec3(0.2f), glm::vec3(5));
  builder.box("room", {-2, 0, -2}, {2, 3, 2}, {0, 0, 1, 0.5f}, grey, true);
  builder.set_movable(
      builder.box("a", {0.3f, 0.3f, 0.2f}, {0.9f, 0.9f, 0.8f}, {0.5f, 0.5f, 0.875f, 0.75f}, grey));
  const auto lamp = [&](const char* name, float x, Chart chart, int material) {
    const int node = square(builder, name, 2.9f, true, chart, material, 0.2f, x);
    builder.gltf["nodes"][static_cast<std::size_t>(node)]["extras"]["switchable"] = true;
  };
  lamp("lamp", -1, {0, 0.5f, 0.1f, 0.6f}, glow);
  lamp("twin", 1, {0, 0.625f, 0.1f, 0.725f}, glow);
  const int point = add_light(builder, {-1, 2, 1}, {{"type", "point"}, {"intensity", 2}});
  builder.gltf["nodes"][static_cast<std::size_t>(point)]["extras"]["switchable"] = true;
  square(builder, "always", 2.8f, true, {0, 0.75f, 0.1f, 0.85f}, glow, 0.1f);
  return loaded(builder);
}

class Dimming : public PunctualLights {
 protected:
  const scene::Scene scene_ = room_of_lights();
  const scene::Scales scales_ = {glm::vec3(1), glm::vec3(0), {0.5f, 0.25f, 2}, glm::vec3(3)};
};

TEST_F(Dimming, IsAsIfTheFileSaidSo) {
  const auto file = scene::dimmed(scene_, scales_);
  for (const std::string engine : {"rays", "links"}) {
    const Settings settings{.size = 64, .psf = 96, .bounces = 3};
    const auto light = make_light_field(engine, device(), scene_, settings);
    settled(*light, at_rest(scene_));
    auto moved = at_rest(scene_);
    moved[1] = {-0.4f, 0.2f, -0.3f};
    settled(*light, moved);
    light->dim(scales_);
    EXPECT_EQ(light->light(), Light::moved);
    light->settle();
    const auto fresh = make_light_field(engine, device(), file, settings);
    settled(*fresh, moved);
    EXPECT_LT(reference::error_of(light->irradiance(), fresh->irradiance()).rel_max, 1e-5) << engine;
    EXPECT_EQ(light->shown().bytes, fresh->shown().bytes) << engine << ": how bright lamps are shown";
    light->dim(scene::full(scene_));
    settled(*light, at_rest(scene_));
    const auto before = make_light_field(engine, device(), scene_, settings);
    settled(*before, at_rest(scene_));
    EXPECT_EQ(light->irradiance(), before->irradiance()) << engine << ": there and back";
  }
}

TEST_F(Dimming, LightsAddUp) {
  const Settings settings{.size = 64, .psf = 96, .bounces = 4};
  const auto light = make_light_field("rays", device(), scene_, settings);
  settled(*light, at_rest(scene_));
  const auto all = light->irradiance();
  std::vector<glm::vec4> sum(all.size(), glm::vec4(0));
  for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
    scene::Scales one(scene_.lights.size(), glm::vec3(0));
    one[i] = glm::vec3(1);
    light->dim(one);
    light->settle();
    const auto part = light->irradiance();
    for (std::size_t texel = 0; texel < sum.size(); ++texel) sum[texel] += glm::vec4(glm::vec3(part[texel]), 0);
  }
  for (std::size_t texel = 0; texel < sum.size(); ++texel) sum[texel].a = all[texel].a;
  EXPECT_LT(reference::error_of(sum, all).rel_rmse, 1e-5);
}

TEST_F(Dimming, FindsNoLinkAnew) {
  const auto light = make_light_field("rays", device(), scene_, {.size = 64, .psf = 96});
  settled(*light, at_rest(scene_));
  const auto calls = [&] { return light->times().host.at("links").calls; };
  const auto before = calls();
  light->dim(scales_);
  light->step([](std::uint32_t) { return true; });
  EXPECT_EQ(calls(), before);
  EXPECT_EQ(light->solution().bounces, 1u);
}

TEST_F(Dimming, WhatCannotBeIsRefused) {
  const auto light = make_light_field("rays", device(), scene_, {.size = 32, .psf = 24});
  EXPECT_THROW(light->dim({glm::vec3(1)}), std::invalid_argument);
  for (const float bad : {-1.0f, std::nanf(""), INFINITY}) {
    auto scales = scales_;
    scales[2].g = bad;
    EXPECT_THROW(light->dim(scales), std::invalid_argument) << bad;
  }
  const auto square_room = furnace(0.5f);
  const auto links =
      make_light_field("links", device(), square_room, {.size = 32, .psf = 24, .direct = Direct::psf});
  EXPECT_THROW(links->dim({glm::vec3(0.5f)}), std::invalid_argument);
}

}  // namespace
}  // namespace lichtveld::lightfield
