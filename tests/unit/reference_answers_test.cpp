// --method reference against exact answers.
#include <gtest/gtest.h>

#include "form_factors.hpp"
#include "reference_scenes.hpp"
#include "shapes.hpp"

namespace lichtveld::reference {
namespace {

using namespace lichtveld::testing;

class Furnace : public ::testing::TestWithParam<float> {};

// Every wall of a closed room of one albedo and one emission gets pi * Le * (1 + rho + .. + rho^(n-1)).
TEST_P(Furnace, HasTheGeometricSum) {
  const double rho = GetParam();
  const auto scene = furnace(GetParam(), 2);
  for (const std::optional<std::uint32_t> bounces :
       {std::optional(1u), std::optional(2u), std::optional(5u), {}}) {
    const auto baked = traced(scene, {.size = 16, .bounces = bounces, .spp = 256});
    const double exact = 2 * pi * (bounces ? 1 - std::pow(rho, *bounces) : 1) / (1 - rho);
    const auto mean = baked.mean(whole_atlas);
    EXPECT_NEAR(mean.value, exact, 4 * mean.standard_error) << "bounces " << bounces.value_or(0);
    EXPECT_LT(mean.standard_error, 0.005 * exact) << "bounces " << bounces.value_or(0);
    const double deviations = baked.squared_deviations(whole_atlas, [&](float, float) { return exact; });
    EXPECT_GT(deviations, 0.75) << "bounces " << bounces.value_or(0);
    EXPECT_LT(deviations, 1.7) << "bounces " << bounces.value_or(0);
    EXPECT_EQ(baked.light.misses, 0u);
    EXPECT_EQ(baked.light.rays, 256u * baked.light.texels_valid);
  }
}

INSTANTIATE_TEST_SUITE_P(Albedos, Furnace, ::testing::Values(0.2f, 0.5f, 0.9f));

TEST(ReferenceAnswers, RadianceOfAnyMagnitudeScales) {
  const auto unit = traced(furnace(0.5f, 1), {.size = 16, .bounces = 3, .spp = 16});
  for (const float emission : {1e-6f, 1e6f}) {
    const auto baked = traced(furnace(0.5f, emission), {.size = 16, .bounces = 3, .spp = 16});
    EXPECT_NEAR(baked.mean(whole_atlas).value / emission / unit.mean(whole_atlas).value, 1, 1e-4) << emission;
  }
}

// A room of one albedo 1 loses nothing: the sum diverges, but every path ends.
TEST(ReferenceAnswers, WhiteFurnaceEnds) {
  const auto baked = traced(furnace(1), {.size = 16, .spp = 16});
  EXPECT_GT(baked.mean(whole_atlas).value, 10 * pi);
}

// E = pi * F * Le.
TEST(ReferenceAnswers, ParallelSquaresHaveTheirFormFactor) {
  SceneBuilder builder;
  square(builder, "lamp", 2, true, chart_a, builder.material(glm::vec3(0), glm::vec3(10)));
  square(builder, "floor", 0, false, chart_b, builder.material(glm::vec3(0.5)));
  const auto baked = traced(loaded(builder), {.size = 64, .bounces = 1, .spp = 256});
  const auto mean = baked.mean(chart_b);
  EXPECT_LT(mean.standard_error, 0.0005 * mean.value);
  EXPECT_NEAR(mean.value / (10 * pi * parallel_squares), 1,
              0.002);  // and the midpoint rule over 24 x 24 texels
  EXPECT_EQ(baked.mean(chart_a).value, 0);
  EXPECT_GT(baked.light.misses, baked.light.rays / 2) << "an open scene";
}

TEST(ReferenceAnswers, PerpendicularSquaresHaveTheirFormFactor) {
  SceneBuilder builder;
  builder.quad("lamp", {glm::vec3(-1, 0, 1), {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1}}, chart_a,
               builder.material(glm::vec3(0), glm::vec3(10)));
  square(builder, "floor", 0, false, chart_b, builder.material(glm::vec3(0.5)));
  const auto baked = traced(loaded(builder), {.size = 64, .bounces = 1, .spp = 1024});
  const auto mean = baked.mean(chart_b);
  EXPECT_LT(mean.standard_error, 0.001 * mean.value);
  EXPECT_NEAR(mean.value / (10 * pi * perpendicular_squares), 1,
              0.004);  // E is steep near the edge: the midpoint rule again
}

// A lamp 20 cm wide, 2 m above a floor: the exact answer of each texel, and whether its standard error explains
// what it is off by. The floor's chart runs with x to the right and z down.
TEST(ReferenceAnswers, ASmallLampIsExactAtEachTexelAndErrorsAreHonest) {
  SceneBuilder builder;
  square(builder, "lamp", 2, true, chart_a, builder.material(glm::vec3(0), glm::vec3(100)), 0.1f);
  square(builder, "floor", 0, false, chart_b, builder.material(glm::vec3(0.5)));
  const auto exact = [&](float u, float v) {
    const double x = 2 * (u - chart_b.u0) / (chart_b.u1 - chart_b.u0) - 1,
                 z = 2 * (v - chart_b.v0) / (chart_b.v1 - chart_b.v0) - 1, h = 0.1;
    return 100 * pi * rectangle_factor(x, z, h, h, 2);
  };
  const auto baked = traced(loaded(builder), {.size = 64, .bounces = 1, .spp = 256});
  double worst = 0;
  baked.each(chart_b, [&](float u, float v, const glm::vec3& irradiance, double) {
    worst = std::max(worst, std::abs(irradiance.g / exact(u, v) - 1));
  });
  EXPECT_LT(worst, 0.02);
  const double deviations = baked.squared_deviations(chart_b, exact);
  EXPECT_GT(deviations, 0.8);
  EXPECT_LT(deviations, 1.6);
}

// The same with a disc: E = pi * Le * r^2 / (r^2 + h^2) on its axis (Howell, B-12).
TEST(ReferenceAnswers, ADiscOnItsAxis) {
  SceneBuilder builder;
  disc(builder, "disc", {0, 1, 0}, 0.5f, chart_a, builder.material(glm::vec3(0), glm::vec3(10)));
  square(builder, "floor", 0, false, chart_b, builder.material(glm::vec3(0.5)), 1e-3f);
  const auto mean = traced(loaded(builder), {.size = 32, .bounces = 1, .spp = 4096}).mean(chart_b);
  EXPECT_NEAR(mean.value / (10 * pi * 0.25 / 1.25), 1, 0.001);
  EXPECT_NEAR(mean.value, 10 * pi * 0.25 / 1.25, 4 * mean.standard_error + 1e-4 * mean.value);
}

// A ceiling that glows from wall to wall, as the players' room has it. Next to it on a wall, half the sky
// glows: E = pi * Le / 2. MIS keeps what points on the lamp would scatter there.
TEST(ReferenceAnswers, WallsThatTouchTheLampAreFreeOfFireflies) {
  SceneBuilder builder;
  builder.quad("lamp", {glm::vec3(-100, 0, -100), {100, 0, -100}, {100, 0, 100}, {-100, 0, 100}}, chart_a,
               builder.material(glm::vec3(0), glm::vec3(1)));
  builder.quad("wall", {glm::vec3(0.5f, -1, 0), {-0.5f, -1, 0}, {-0.5f, 0, 0}, {0.5f, 0, 0}}, chart_b,
               builder.material(glm::vec3(0.5)));
  const auto baked = traced(loaded(builder), {.size = 32, .bounces = 1, .spp = 64});
  baked.each(chart_b, [&](float, float, const glm::vec3& irradiance, double error) {
    EXPECT_NEAR(irradiance.g, pi / 2, 6 * error + 0.01 * pi / 2);
    EXPECT_LT(error, 0.06 * pi / 2);
  });
}

}  // namespace
}  // namespace lichtveld::reference
