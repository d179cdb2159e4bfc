// How far a light map is from the truth, by hand.
#include "lichtveld/reference/error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace lichtveld::reference {
namespace {

// Grey texels; a NaN stands for one that is not valid, whatever it holds.
std::vector<glm::vec4> map_of(const std::vector<float>& values) {
  std::vector<glm::vec4> map;
  for (const float value : values)
    map.push_back(std::isnan(value) ? glm::vec4(1000, 1000, 1000, 0) : glm::vec4(value, value, value, 1));
  return map;
}

TEST(ReferenceError, IsAShareOfTheTruthsMean) {
  const auto error = error_of(map_of({1, 3, 1, 7}), map_of({2, 2, NAN, 2}));
  EXPECT_DOUBLE_EQ(error.rel_rmse, std::sqrt((1 + 1 + 25) / 3.0) / 2);
  EXPECT_DOUBLE_EQ(error.rel_max, 5.0 / 2);
  EXPECT_DOUBLE_EQ(error.bias, (-1 + 1 + 5) / 3.0 / 2);
}

TEST(ReferenceError, P99LeavesOutTheWorstHundredth) {
  std::vector<float> truth(1000, 1), light = truth;
  for (int texel = 0; texel < 9; ++texel) light[texel] = 5;
  EXPECT_EQ(error_of(map_of(light), map_of(truth)).rel_p99, 0);
  for (int texel = 0; texel < 11; ++texel) light[texel] = 5;
  EXPECT_EQ(error_of(map_of(light), map_of(truth)).rel_p99, 4);
}

TEST(ReferenceError, IsNotKnownInTheDark) {
  EXPECT_TRUE(std::isnan(error_of(map_of({1, 1}), map_of({0, 0})).rel_rmse));
}

TEST(ReferenceError, RefusesMapsOfDifferentSizes) {
  EXPECT_THROW(error_of(map_of({1}), map_of({1, 1})), std::invalid_argument);
}

}  // namespace
}  // namespace lichtveld::reference
