// Solution::error_estimate against the error there is.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "device_for_tests.hpp"
#include "known_scenes.hpp"
#include "lichtveld/reference/path_tracer.hpp"
#include "light_fields.hpp"

namespace lichtveld::stability {
namespace {

using namespace testing;

struct EstimatedScene {
  std::string name;
  std::function<scene::Scene()> load;
  std::vector<glm::vec3> offsets = {};  // of the bodies [m]
};

void PrintTo(const EstimatedScene& of, std::ostream* out) {
  *out << of.name;
}

scene::Scene cornell() {
  return scene::load(LICHTVELD_SOURCE_DIR "/assets/cornell.glb");
}

// A lamp under the ceiling, and three pillars from floor to ceiling.
scene::Scene pillars() {
  SceneBuilder builder;
  builder.box("room", {-2, 0, -2}, {2, 3, 2}, {0, 0, 1, 0.5f}, builder.material(glm::vec3(0.7f, 0.6f, 0.5f)),
              true);
  builder.quad("lamp",
               {glm::vec3(-0.7f, 2.9f, -0.7f), {0.7f, 2.9f, -0.7f}, {0.7f, 2.9f, 0.7f}, {-0.7f, 2.9f, 0.7f}},
               {0.8f, 0.6f, 0.95f, 0.75f}, builder.material(glm::vec3(0.5f), glm::vec3(10, 9, 8)));
  const int grey = builder.material(glm::vec3(0.5f));
  float u = 0;
  for (const glm::vec2 at : {glm::vec2(-1.2f, -1), {0.9f, -1.1f}, {0.2f, 1.2f}}) {
    builder.box("pillar", {at.x - 0.2f, 0, at.y - 0.2f}, {at.x + 0.2f, 3, at.y + 0.2f}, {u, 0.5f, u + 0.25f, 1},
                grey);
    u += 0.25f;
  }
  return loaded(builder);
}

// A floor and a wall at its back under the void, a block, and a lamp above them.
scene::Scene stage() {
  SceneBuilder builder;
  const int white = builder.material(glm::vec3(0.7f)), red = builder.material(glm::vec3(0.7f, 0.2f, 0.1f));
  square(builder, "floor", 0, false, {0.05f, 0.05f, 0.45f, 0.45f}, white, 2);
  builder.quad("back", {glm::vec3(-2, 0, -2), {2, 0, -2}, {2, 2, -2}, {-2, 2, -2}},
               {0.55f, 0.05f, 0.95f, 0.25f}, red);
  square(builder, "lamp", 2.5f, true, {0.55f, 0.3f, 0.7f, 0.45f}, builder.material(glm::vec3(0), glm::vec3(10)),
         0.8f);
  builder.box("block", {-0.8f, 0, -0.6f}, {0.2f, 0.9f, 0.4f}, {0, 0.5f, 1, 1}, white);
  return loaded(builder);
}

// 12 m long, lit at one end, with a crate half way.
scene::Scene corridor() {
  SceneBuilder builder;
  builder.box("corridor", {-6, 0, -1}, {6, 2.5f, 1}, {0, 0, 1, 0.6f},
              builder.material(glm::vec3(0.6f, 0.7f, 0.6f)), true);
  builder.quad("lamp", {glm::vec3(-5, 2.4f, -0.6f), {-3, 2.4f, -0.6f}, {-3, 2.4f, 0.6f}, {-5, 2.4f, 0.6f}},
               {0.8f, 0.65f, 0.95f, 0.95f}, builder.material(glm::vec3(0.5f), glm::vec3(10)));
  builder.box("crate", {0, 0, -0.7f}, {1, 1, 0.3f}, {0, 0.6f, 0.75f, 1}, builder.material(glm::vec3(0.4f)));
  return loaded(builder);
}

// The rel_rmse against the exact answer. Two traces with noise of their own stand for it: in the product of
// what the map is off from either, the noise has a mean of zero.
double true_error(const std::vector<glm::vec4>& map, const std::vector<glm::vec4>& one,
                  const std::vector<glm::vec4>& other) {
  double squares = 0, sum = 0, values = 0;
  for (std::size_t texel = 0; texel < map.size(); ++texel) {
    if (map[texel].a == 0) continue;
    const glm::dvec3 a(one[texel]), b(other[texel]), light(map[texel]);
    squares += glm::dot(light - a, light - b);
    sum += glm::dot(a + b, glm::dvec3(0.5));
    values += 3;
  }
  return std::sqrt(std::max(squares, 0.0) * values) / sum;
}

class ErrorEstimate : public WithDevice, public ::testing::WithParamInterface<EstimatedScene> {};

TEST_P(ErrorEstimate, IsAboutTheError) {
  constexpr std::uint32_t size = 64, bounces = 3;
  const auto scene = GetParam().load();
  auto offsets = GetParam().offsets;
  offsets.resize(scene.bodies.size(), glm::vec3(0));
  const auto traced = [&](std::uint64_t seed) {
    return reference::trace(scene, offsets, {.size = size, .bounces = bounces, .spp = 512, .seed = seed})
        .texels;
  };
  const auto one = traced(1), other = traced(2);
  const auto compare = [&](const char* method, std::uint32_t psf, double factor) {
    const auto light = lightfield::make_light_field(
        method, device(), scene,
        {.size = size,
         .psf = psf,
         .bounces = bounces,
         .thesis = {.abuffer = lightfield::ABuffer::list, .sort = lightfield::Sort::scan}});
    const double estimate = settled(*light, offsets).error_estimate,
                 error = true_error(light->irradiance(), one, other);
    std::printf("%-18s %-6s %4u PSFs: estimate %6.2f %%, true %6.2f %%, ratio %.2f\n", GetParam().name.c_str(),
                method, psf, 100 * estimate, 100 * error, estimate / error);
    EXPECT_LT(estimate / error, factor) << method << " " << psf;
    EXPECT_GT(estimate / error, 1 / factor) << method << " " << psf;
  };
  for (const std::uint32_t psf : {24u, 96u, 384u}) compare("thesis", psf, 1.5);
  // Of so small an error the reference's noise is a part that two of them do not cancel. What halves of a
  // lattice differ by is more than what both are off.
  compare("rays", 24, 2.5);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, ErrorEstimate,
    ::testing::Values(EstimatedScene{"cornell", cornell},
                      EstimatedScene{"cornell_moved", cornell, {{}, {-0.5f, 0.4f, 0.2f}, {0.4f, 0.3f, -0.3f}}},
                      EstimatedScene{"pillars", pillars}, EstimatedScene{"stage", stage},
                      EstimatedScene{"corridor", corridor}),
    [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace lichtveld::stability
