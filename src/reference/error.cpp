#include "lichtveld/reference/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace lichtveld::reference {

Error error_of(std::span<const glm::vec4> irradiance, std::span<const glm::vec4> truth) {
  if (irradiance.size() != truth.size())
    throw std::invalid_argument("light maps of " + std::to_string(irradiance.size()) + " and " +
                                std::to_string(truth.size()) + " texels cannot be compared");
  std::vector<double> differences;
  double squares = 0, signed_sum = 0, sum = 0;
  for (std::size_t texel = 0; texel < truth.size(); ++texel) {
    if (truth[texel].a == 0) continue;
    for (int channel = 0; channel < 3; ++channel) {
      const double difference = double{irradiance[texel][channel]} - truth[texel][channel];
      squares += difference * difference;
      signed_sum += difference;
      sum += truth[texel][channel];
      differences.push_back(std::abs(difference));
    }
  }
  if (!(sum > 0)) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan, nan};
  }
  const auto values = static_cast<double>(differences.size());
  const double mean = sum / values;
  const auto p99 = differences.begin() + static_cast<std::ptrdiff_t>((differences.size() - 1) * 99 / 100);
  std::nth_element(differences.begin(), p99, differences.end());
  return {.rel_rmse = std::sqrt(squares / values) / mean,
          .rel_p99 = *p99 / mean,
          .rel_max = *std::max_element(p99, differences.end()) / mean,
          .bias = signed_sum / sum};
}

double expected_rel_rmse(const Irradiance& traced) {
  double squares = 0, sum = 0;
  for (std::size_t texel = 0; texel < traced.texels.size(); ++texel) {
    if (traced.texels[texel].a == 0) continue;
    squares += double{traced.standard_error[texel]} * traced.standard_error[texel];
    sum += (double{traced.texels[texel].r} + traced.texels[texel].g + traced.texels[texel].b) / 3;
  }
  return sum > 0 ? std::sqrt(squares * traced.texels_valid) / sum : 0;
}

}  // namespace lichtveld::reference
