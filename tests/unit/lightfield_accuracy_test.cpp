// What the settings do to the error: the PSFs' pixels, the directions' weights, the seed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "device_for_tests.hpp"
#include "form_factors.hpp"
#include "known_scenes.hpp"
#include "lichtveld/reference/error.hpp"
#include "light_fields.hpp"
#include "texels.hpp"

namespace lichtveld::lightfield {
namespace {

using namespace lichtveld::testing;

class LightFieldAccuracy : public WithDevice {
 protected:
  struct Baked {
    Solution solution;
    std::vector<glm::vec4> irradiance;
  };

  Baked bake(const scene::Scene& scene, Settings settings) {
    settings.thesis.abuffer = ABuffer::list;
    settings.thesis.sort = Sort::scan;
    const auto method = make_light_field("thesis", device(), scene, settings);
    const auto solution = method->settle();
    return {solution, method->irradiance()};
  }
};

// A lit room with a block on its floor.
scene::Scene room_with_a_block() {
  SceneBuilder builder;
  builder.box("room", {-1, 0, -1}, {1, 2, 1}, {0, 0, 1, 0.6f},
              builder.material(glm::vec3(0.6f), glm::vec3(0.1f)), true);
  builder.quad("lamp",
               {glm::vec3(-0.7f, 1.9f, -0.7f), {0.7f, 1.9f, -0.7f}, {0.7f, 1.9f, 0.7f}, {-0.7f, 1.9f, 0.7f}},
               {0.8f, 0.65f, 0.95f, 0.95f}, builder.material(glm::vec3(0), glm::vec3(10)));
  builder.box("block", {-0.5f, 0, -0.3f}, {0.1f, 0.7f, 0.4f}, {0, 0.6f, 0.75f, 1},
              builder.material(glm::vec3(0.5f)));
  return loaded(builder);
}

// The directions are the same, so that what differs from a raster of four times the pixels is the pixels'
// doing.
TEST_F(LightFieldAccuracy, FinerPsfsComeNearer) {
  const auto scene = room_with_a_block();
  const auto with_pixels = [&](std::uint32_t pixels) {
    return bake(scene, {.size = 64, .psf = 96, .psf_size = pixels, .bounces = 2}).irradiance;
  };
  const auto fine = with_pixels(512);
  const double once = reference::error_of(with_pixels(64), fine).rel_rmse,
               twice = reference::error_of(with_pixels(128), fine).rel_rmse;
  std::printf("against PSFs of 8x: 1x %.2f %%, 2x %.2f %%\n", 100 * once, 100 * twice);
  EXPECT_LT(twice, 0.75 * once);
}

// The thesis' correction factor: without it the octahedron's crowded directions weigh too much.
TEST_F(LightFieldAccuracy, EqualWeightsAreFurtherOff) {
  SceneBuilder builder;
  square(builder, "lamp", 2, true, chart_a, builder.material(glm::vec3(0), glm::vec3(10)));
  square(builder, "floor", 0, false, chart_b, builder.material(glm::vec3(0)));
  black_room(builder, "ceiling");
  const auto scene = loaded(builder);
  constexpr std::uint32_t size = 64;
  const auto mean_error = [&](Weights weights) {
    constexpr int seeds = 8;
    double sum = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const auto baked =
          bake(scene, {.size = size, .psf = 384, .bounces = 1, .weights = weights, .seed = seed});
      sum += rel_rmse(of(texels(scene, size, baked.irradiance, {}), "floor"), [](const Texel& texel) {
        return pi * 10 * rectangle_factor(texel.position.x, texel.position.z, 1, 1, 2);
      });
    }
    return sum / seeds;
  };
  const double solid_angle = mean_error(Weights::solid_angle), equal = mean_error(Weights::equal);
  std::printf("rel_rmse, mean over seeds: by solid angle %.2f %%, equal %.2f %%\n", 100 * solid_angle,
              100 * equal);
  EXPECT_GT(equal, 1.1 * solid_angle);
}

TEST_F(LightFieldAccuracy, AnotherSeedGivesTheSameAnswerInOtherBits) {
  const auto scene = room_with_a_block();
  const auto with_seed = [&](std::uint64_t seed) {
    return bake(scene, {.size = 64, .psf = 96, .bounces = 2, .seed = seed});
  };
  const auto first = with_seed(0), again = with_seed(0), other = with_seed(1);
  EXPECT_EQ(first.irradiance, again.irradiance);
  EXPECT_NE(first.irradiance, other.irradiance);
  // Two answers that are off by e1 and e2, independently, differ by the root of e1^2 + e2^2.
  const double apart = reference::error_of(other.irradiance, first.irradiance).rel_rmse,
               expected = std::hypot(first.solution.error_estimate, other.solution.error_estimate);
  std::printf("two seeds differ by %.2f %%, their estimates expect %.2f %%\n", 100 * apart, 100 * expected);
  EXPECT_NEAR(apart / expected, 1, 0.5);
}

}  // namespace
}  // namespace lichtveld::lightfield
