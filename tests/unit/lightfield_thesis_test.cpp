// --method thesis on small scenes whose answers are known.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "device_for_tests.hpp"
#include "lichtveld/reference/error.hpp"
#include "light_fields.hpp"
#include "scene_builder.hpp"

namespace lichtveld::lightfield {
namespace {

using lichtveld::testing::at_rest;
using lichtveld::testing::Chart;
using lichtveld::testing::SceneBuilder;
using lichtveld::testing::settled;
using lichtveld::testing::TempFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
constexpr double pi = std::numbers::pi;

scene::Scene load(const SceneBuilder& builder) {
  const TempFolder folder;
  return scene::load(folder.write("scene.glb", builder.glb()));
}

// A closed box [-1, 1]^3 whose walls all emit `emission` and reflect `albedo`.
scene::Scene furnace(float albedo, float emission = 1) {
  SceneBuilder builder;
  builder.box("room", glm::vec3(-1), glm::vec3(1), {0, 0, 1, 1},
              builder.material(glm::vec3(albedo), glm::vec3(emission)), true);
  return load(builder);
}

// A square of side 2 at height y that faces down (or up), in a chart of its own.
void square(SceneBuilder& builder, const char* name, float y, bool down, Chart chart, int material) {
  if (down)
    builder.quad(name, {glm::vec3(-1, y, -1), {1, y, -1}, {1, y, 1}, {-1, y, 1}}, chart, material);
  else
    builder.quad(name, {glm::vec3(-1, y, 1), {1, y, 1}, {1, y, -1}, {-1, y, -1}}, chart, material);
}

constexpr Chart first_chart{0.05f, 0.05f, 0.45f, 0.45f}, second_chart{0.55f, 0.05f, 0.95f, 0.45f};

struct Baked {
  Solution solution;
  std::vector<glm::vec4> irradiance;
  std::uint32_t size;

  // The mean of E's green over the texels of a chart.
  double mean(Chart chart) const {
    double sum = 0;
    int count = 0;
    for (std::uint32_t y = 0; y < size; ++y)
      for (std::uint32_t x = 0; x < size; ++x) {
        const float u = (x + 0.5f) / size, v = (y + 0.5f) / size;
        if (u < chart.u0 || u > chart.u1 || v < chart.v0 || v > chart.v1) continue;
        const auto& texel = irradiance[y * size + x];
        if (texel.a == 0) continue;
        sum += texel.g;
        ++count;
      }
    return sum / count;
  }
};

class ThesisMethod : public lichtveld::testing::WithDevice {
 protected:
  Baked bake(const scene::Scene& scene, const Settings& settings, std::vector<glm::vec3> offsets = {}) {
    offsets.resize(scene.bodies.size(), glm::vec3(0));
    const auto method = make_light_field("thesis", device(), scene, settings);
    const auto solution = settled(*method, offsets);
    return {solution, method->irradiance(), settings.size};
  }
};

double rel_rmse(const Baked& a, const Baked& b) {
  return reference::error_of(a.irradiance, b.irradiance).rel_rmse;
}

// Every wall sees pi * Le * (1 + rho + rho^2 + ..) : rows sum to one, so that nothing but a miss can spoil it.
TEST_F(ThesisMethod, FurnaceIsExactWithTheList) {
  const auto baked =
      bake(furnace(0.5f), {.size = 64, .psf = 96, .bounces = 3, .thesis = {.abuffer = ABuffer::list}});
  const double expected = pi * (1 + 0.5 + 0.25);
  for (const auto& texel : baked.irradiance) {
    if (texel.a == 0) continue;
    ASSERT_NEAR(texel.g / expected, 1, 1e-4);
  }
  EXPECT_EQ(baked.solution.misses, 0u);
  EXPECT_GT(baked.solution.rays, 96u * baked.solution.texels_valid / 3);
}

TEST_F(ThesisMethod, FurnaceConvergesByItself) {
  const auto baked = bake(furnace(0.8f), {.size = 32, .psf = 24, .thesis = {.abuffer = ABuffer::list}});
  EXPECT_NEAR(baked.mean({0, 0, 1, 1}) / (pi / (1 - 0.8)), 1, 1e-3);
  EXPECT_LT(baked.solution.residual, 1e-3);
  // The change shrinks by the albedo: 0.8^(n-1) * 0.2 / 0.2 < 0.001.
  EXPECT_NEAR(baked.solution.bounces, 1 + std::log(1e-3) / std::log(0.8), 2);
}

// Stencil routing takes its layers at sample positions: at the silhouette some see another surface, or none.
TEST_F(ThesisMethod, FurnaceIsNearWithTheStencil) {
  const auto baked = bake(furnace(0.5f), {.size = 64, .psf = 96, .bounces = 3});
  const double deviation = baked.mean({0, 0, 1, 1}) / (pi * 1.75) - 1;
  std::printf("stencil furnace: the mean is %.3f %% off\n", 100 * deviation);
  EXPECT_NEAR(deviation, 0, 0.015);
}

TEST_F(ThesisMethod, RadianceOfAnyMagnitudeScales) {
  for (const float emission : {1e-6f, 1e6f}) {
    const auto baked = bake(furnace(0.5f, emission),
                            {.size = 32, .psf = 24, .bounces = 2, .thesis = {.abuffer = ABuffer::list}});
    EXPECT_NEAR(baked.mean({0, 0, 1, 1}) / (emission * pi * 1.5), 1, 1e-4) << emission;
  }
}

// Parallel squares of side 2, 2 apart: form factor 0.199825 (Howell, Radiation Configuration Factors, C-11).
// E = pi * F * Le, and nothing else is hit.
TEST_F(ThesisMethod, ParallelSquaresHaveTheirFormFactor) {
  SceneBuilder builder;
  square(builder, "lamp", 1, true, first_chart, builder.material(glm::vec3(0), glm::vec3(10)));
  square(builder, "floor", -1, false, second_chart, builder.material(glm::vec3(0.5)));
  const auto scene = load(builder);
  for (const auto abuffer : {ABuffer::list, ABuffer::stencil}) {
    const auto baked = bake(
        scene, {.size = 128, .psf = 1536, .bounces = 1, .thesis = {.abuffer = abuffer, .sort = Sort::scan}});
    EXPECT_NEAR(baked.mean(second_chart) / (pi * 0.199825 * 10), 1, 0.02);
    EXPECT_GT(baked.solution.misses,
              baked.solution.rays / 2);  // an open scene: most rays hit nothing, and that shows
  }
}

TEST_F(ThesisMethod, OneSidedSurfacesAreSeenFromTheirFrontAlone) {
  for (const bool double_sided : {false, true}) {
    SceneBuilder builder;
    square(builder, "lamp", 1, false, first_chart,
           builder.material(glm::vec3(0), glm::vec3(10), double_sided));  // faces up
    square(builder, "floor", -1, false, second_chart, builder.material(glm::vec3(0.5)));
    const auto baked =
        bake(load(builder), {.size = 64, .psf = 384, .bounces = 1, .thesis = {.abuffer = ABuffer::list}});
    if (double_sided) {
      EXPECT_NEAR(baked.mean(second_chart) / (pi * 0.199825 * 10), 1, 0.05);
    } else {
      EXPECT_EQ(baked.mean(second_chart), 0);
    }
    EXPECT_EQ(baked.mean(first_chart), 0) << "a double-sided lamp must not light itself";
  }
}

// A lid that lies on the floor hides it: depths equal within rounding count as in front.
TEST_F(ThesisMethod, ASurfaceInContactBlocksTheLight) {
  SceneBuilder builder;
  square(builder, "lamp", 1, true, first_chart, builder.material(glm::vec3(0), glm::vec3(10)));
  square(builder, "floor", -1, false, second_chart, builder.material(glm::vec3(0.5)));
  square(builder, "lid", -1, true, {0.05f, 0.55f, 0.45f, 0.95f}, builder.material(glm::vec3(0.5)));
  const auto baked =
      bake(load(builder), {.size = 64, .psf = 384, .bounces = 1, .thesis = {.abuffer = ABuffer::list}});
  const float inset = 2.0f / 64;  // the rim sees past the lid's rasterised edge
  const double inside = baked.mean(
      {second_chart.u0 + inset, second_chart.v0 + inset, second_chart.u1 - inset, second_chart.v1 - inset});
  EXPECT_LT(inside, 0.001 * pi * 0.2 * 10);
}

// The lamp is the layer behind `plates` one-sided plates that face down too; the floor is to see the lowest
// plate.
class Plates : public ThesisMethod, public ::testing::WithParamInterface<ABuffer> {};

TEST_P(Plates, LayersBeyondTheLimitAreCountedAndRenderedAllTheSame) {
  constexpr int plates = 11;
  SceneBuilder builder;
  const int dark = builder.material(glm::vec3(0)), bright = builder.material(glm::vec3(0), glm::vec3(10));
  square(builder, "floor", -1, false, {0.02f, 0.02f, 0.23f, 0.23f}, dark);
  for (int plate = 0; plate < plates; ++plate) {  // the nearest is drawn last: the first to be lost
    const float u = 0.02f + 0.25f * static_cast<float>((plate + 1) % 4),
                v = 0.02f + 0.25f * static_cast<float>((plate + 1) / 4);
    square(builder, "plate", 1 - 0.1f * static_cast<float>(plate), true, {u, v, u + 0.21f, v + 0.21f},
           plate == plates - 1 ? bright : dark);
  }
  const auto scene = load(builder);
  const auto roomy =
      bake(scene, {.size = 64, .psf = 96, .bounces = 1, .layers = 16, .thesis = {.abuffer = GetParam()}});
  const auto tight =
      bake(scene, {.size = 64, .psf = 96, .bounces = 1, .layers = 2, .thesis = {.abuffer = GetParam()}});
  EXPECT_EQ(roomy.solution.depth_layers_max, 11u);
  EXPECT_EQ(roomy.solution.overflow_pixels, 0u);
  EXPECT_EQ(tight.solution.depth_layers_max, 11u);
  EXPECT_GT(tight.solution.overflow_pixels, 0u);
  EXPECT_LT(rel_rmse(tight, roomy), 1e-6);
  EXPECT_GT(tight.mean({0.02f, 0.02f, 0.23f, 0.23f}), 1) << "the nearest plate is the bright one";
}

INSTANTIATE_TEST_SUITE_P(BothABuffers, Plates, ::testing::Values(ABuffer::stencil, ABuffer::list));

TEST_F(ThesisMethod, SortsAgreeAndABuffersNearlyDo) {
  const auto cornell = scene::load(LICHTVELD_SOURCE_DIR "/assets/cornell.glb");
  const Settings settings{.size = 64, .psf = 96, .bounces = 2};
  const auto stencil = bake(cornell, settings);
  for (const auto sort : {Sort::bitonic, Sort::scan}) {
    auto other = settings;
    other.thesis.sort = sort;
    EXPECT_EQ(rel_rmse(bake(cornell, other), stencil), 0);
  }
  auto list = settings;
  list.thesis.abuffer = ABuffer::list;
  const double difference = rel_rmse(stencil, bake(cornell, list));
  std::printf("stencil against list: rel_rmse %.4f\n", difference);
  EXPECT_LT(difference, 0.08);  // silhouettes, at 64 texels a side
}

TEST_F(ThesisMethod, RepeatsBitForBitAndForgetsEarlierPlaces) {
  const auto cornell = scene::load(LICHTVELD_SOURCE_DIR "/assets/cornell.glb");
  const Settings settings{.size = 64, .psf = 24, .bounces = 2, .thesis = {.abuffer = ABuffer::list}};
  std::vector<glm::vec3> moved(cornell.bodies.size(), glm::vec3(0));
  moved[1] = {-0.5f, 0.4f, 0};
  const auto fresh = bake(cornell, settings, moved);
  const auto method = make_light_field("thesis", device(), cornell, settings);
  settled(*method, at_rest(cornell));
  const auto at_rest = method->irradiance();
  settled(*method, moved);
  EXPECT_EQ(method->irradiance(), fresh.irradiance);
  EXPECT_NE(at_rest, fresh.irradiance);
}

TEST_F(ThesisMethod, AShadowFollowsItsCube) {
  SceneBuilder builder;
  square(builder, "lamp", 1, true, first_chart, builder.material(glm::vec3(0), glm::vec3(10)));
  square(builder, "floor", -1, false, second_chart, builder.material(glm::vec3(0.5)));
  const int cube = builder.box("cube", {-0.3f, -0.9f, -0.3f}, {0.3f, -0.6f, 0.3f}, {0.05f, 0.55f, 0.45f, 0.95f},
                               builder.material(glm::vec3(0.2f)));
  builder.set_movable(cube);
  const auto scene = load(builder);
  const float middle = (second_chart.u0 + second_chart.u1) / 2;
  const Chart left{second_chart.u0, second_chart.v0, middle, second_chart.v1},
      right{middle, second_chart.v0, second_chart.u1, second_chart.v1};
  const Settings settings{.size = 64, .psf = 384, .bounces = 1, .thesis = {.abuffer = ABuffer::list}};
  const auto to_left = bake(scene, settings, {glm::vec3(0), glm::vec3(-0.6f, 0, 0)});
  const auto to_right = bake(scene, settings, {glm::vec3(0), glm::vec3(0.6f, 0, 0)});
  EXPECT_LT(to_left.mean(left), 0.9 * to_left.mean(right));
  EXPECT_LT(to_right.mean(right), 0.9 * to_right.mean(left));
  EXPECT_NEAR(to_left.mean(left) / to_right.mean(right), 1, 0.03);
}

TEST_F(ThesisMethod, NothingThatEmitsGivesBlack) {
  const auto dark = bake(furnace(0.5f, 0), {.size = 32, .psf = 24});
  EXPECT_EQ(dark.mean({0, 0, 1, 1}), 0);
  EXPECT_EQ(dark.solution.residual, 0);
  EXPECT_EQ(dark.solution.bounces, 1u);
}

TEST_F(ThesisMethod, SettingsOutOfRangeAreRefusedByName) {
  const auto scene = furnace(0.5f);
  const auto refusal = [&](const Settings& settings) -> std::string {
    try {
      const auto method = make_light_field("thesis", device(), scene, settings);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_THAT(refusal({.size = 8}), HasSubstr("16..4096"));
  EXPECT_THAT(refusal({.size = 100000}), HasSubstr("16..4096"));
  EXPECT_THAT(refusal({.psf = 100}), HasSubstr("8, 24, 32"));
  EXPECT_THAT(refusal({.psf_size = 15}), AllOf(HasSubstr("PSF raster of 15"), HasSubstr("16..8192")));
  EXPECT_THAT(refusal({.psf_size = 8193}), AllOf(HasSubstr("PSF raster of 8193"), HasSubstr("16..8192")));
  EXPECT_THAT(refusal({.bounces = 0}), HasSubstr("0 bounces"));
  EXPECT_THAT(refusal({.layers = 0}), HasSubstr("1..128"));
  EXPECT_THAT(refusal({.layers = 129}), HasSubstr("1..128"));
}

// The presented map: white walls of one radiance land on Reinhard's middle grey for the log-average, in every
// channel.
TEST_F(ThesisMethod, PresentsUniformLightAsOneGrey) {
  const auto scene = furnace(0.5f, 3);
  const auto method = make_light_field(
      "thesis", device(), scene, {.size = 32, .psf = 24, .bounces = 2, .thesis = {.abuffer = ABuffer::list}});
  settled(*method, {glm::vec3(0)});
  const auto shown = method->shown().bytes;
  // scaled = key = 0.18, white = the same: L (1 + L / white^2) / (1 + L) = 0.18 (1 + 1 / 0.18) / 1.18 = 1.
  for (std::size_t texel = 0; texel < shown.size(); texel += 4) {
    ASSERT_EQ(shown[texel], shown[texel + 1]);
    ASSERT_EQ(shown[texel + 3], 255);
  }
  EXPECT_GE(*std::max_element(shown.begin(), shown.end()), 254);
}

}  // namespace
}  // namespace lichtveld::lightfield
