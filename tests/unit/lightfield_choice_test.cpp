// What is chosen where nobody says: engine, size and directions.
#include "lichtveld/lightfield/choice.hpp"

#include <gtest/gtest.h>

#include <array>

#include "device_for_tests.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {
namespace {

using namespace std::chrono_literals;

class Choice : public lichtveld::testing::WithDevice {
 protected:
  const scene::Scene scene_ = scene::load(LICHTVELD_SOURCE_DIR "/assets/cornell.glb");
  const Engine &thesis_ = engine("thesis"), &links_ = engine("links"), &rays_ = engine("rays");
  static bool never() { return false; }
};

TEST_F(Choice, OnACpuItIsRays) {
  const std::array all = {&thesis_, &links_, &rays_};
  EXPECT_EQ(&suited(all, device(), scene_, {}), &rays_);
  const std::array two = {&thesis_, &links_};
  EXPECT_EQ(&suited(two, device(), scene_, {}), &links_);
  EXPECT_THROW(suited({}, device(), scene_, {}), std::invalid_argument);
}

// As on a GPU; this device is none, so that rays win.
TEST_F(Choice, ATrialFindsTheBetterOne) {
  const std::array all = {&thesis_, &links_, &rays_};
  EXPECT_EQ(&tried(all, device(), scene_, {.size = 128}), &rays_);
}

TEST_F(Choice, MoreTimeBuysLessError) {
  Forecast forecast(rays_, device(), scene_, {.memory = 200 << 20}, {}, never);
  const auto coarse = forecast.of({64, 24}), fine = forecast.of({512, 384});
  EXPECT_LT(fine.error, coarse.error / 2);
  EXPECT_GT(fine.step_ms, 4 * coarse.step_ms);
  EXPECT_GT(fine.first_ms, 4 * coarse.first_ms);
  EXPECT_GE(forecast.finest_within(0ms).error, coarse.error) << "the quickest, where none is in time";
  EXPECT_LT(forecast.finest_within(100ms).error, coarse.error);
  EXPECT_EQ(forecast.quickest_for(1).quality, (Quality{64, 24}));
  EXPECT_GE(forecast.quickest_for(1e-9).quality.size, 256u);
}

TEST_F(Choice, WhatDoesNotFitIsNotChosen) {
  constexpr std::uint64_t memory = 40 << 20;
  const Settings settings{.memory = memory};
  Forecast forecast(rays_, device(), scene_, settings, {}, never);
  for (const auto& chosen : {forecast.quickest_for(1e-9), forecast.finest_within(10s)}) {
    EXPECT_GT(chosen.quality.size * chosen.quality.size * chosen.quality.psf, 128u * 128 * 24);
    EXPECT_NO_THROW(rays_.make(device(), scene_,
                               {.size = chosen.quality.size, .psf = chosen.quality.psf, .memory = memory}));
  }
  EXPECT_THROW(Forecast(rays_, device(), scene_, {.memory = 1}, {}, never), std::runtime_error);
}

TEST_F(Choice, WhatIsFixedStays) {
  Forecast forecast(rays_, device(), scene_, {}, {.size = 32}, never);
  EXPECT_EQ(forecast.quickest_for(1).quality, (Quality{32, 24}));
  EXPECT_EQ(forecast.finest_within(1000ms).quality.size, 32u);
  Forecast by_psf(rays_, device(), scene_, {}, {.psf = 8}, never);
  EXPECT_EQ(by_psf.quickest_for(1).quality, (Quality{64, 8}));
}

// What it says is about what comes: errors within twice, for a rough judgement is all that is needed.
TEST_F(Choice, TheErrorIsAboutWhatIsExpected) {
  Forecast forecast(rays_, device(), scene_, {}, {}, never);
  const auto expected = forecast.of({64, 24});
  const auto map_of = [&](const Quality& quality) {
    const auto light = rays_.make(device(), scene_, {.size = quality.size, .psf = quality.psf});
    light->settle();
    return light->irradiance();
  };
  const auto map = map_of({64, 24}), truth = map_of({64, 1536});
  double squares = 0, sum = 0, count = 0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto apart = glm::vec3(map[i] - truth[i]);
    squares += glm::dot(apart, apart);
    sum += truth[i].r + truth[i].g + truth[i].b;
    count += 3 * truth[i].a;
  }
  const double of_directions = std::sqrt(squares * count) / sum;
  EXPECT_GT(expected.error, of_directions) << "texels have a part in it, too";
  EXPECT_LT(expected.error, 20 * of_directions);
}

TEST_F(Choice, ItEndsEarlyWhenItIsTold) {
  Forecast forecast(rays_, device(), scene_, {}, {}, [] { return true; });
  forecast.finest_within(33ms);
}

}  // namespace
}  // namespace lichtveld::lightfield
