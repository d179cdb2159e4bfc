#include "core/convergence.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lichtveld::lightfield {

void warn_of_no_bound(const Solution& solution) {
  spdlog::warn("still {:.2g} of the mean may be missing after {} bounces: an albedo near 1 bounds nothing",
               solution.residual, solution.bounces);
}

double bound_on_missing(double change, float albedo_max, double mean) {
  if (change == 0) return 0;
  if (albedo_max >= 1) return std::numeric_limits<double>::infinity();
  return change / (1 - albedo_max) / mean;
}

bool bounce_until_converged(const Solution& solution, const std::function<void()>& bounce,
                            const LightField::Enough& enough) {
  // Bounces without progress after which the bound is as low as it gets.
  constexpr std::uint32_t patience = 8;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t since = 0; since < patience;) {
    bounce();
    if (solution.residual < converged || solution.bounces >= most_bounces) return true;
    since = solution.residual < least ? 0 : since + 1;
    least = std::min(least, solution.residual);
    if (since < patience && enough(solution.bounces)) return false;
  }
  return true;
}

Convergence::Convergence(const TexelRecords& records)
    : before_(std::size_t{records.size()} * records.size(), glm::vec4(0)),
      albedo_max_(records.highest_albedo()) {}

double Convergence::measure(std::vector<glm::vec4>&& irradiance) {
  double change = 0, sum = 0, texels = 0;
  for (std::size_t texel = 0; texel < irradiance.size(); ++texel) {
    if (irradiance[texel].a == 0) continue;
    ++texels;
    for (int channel = 0; channel < 3; ++channel) {
      change = std::max(change, std::abs(double{irradiance[texel][channel]} - before_[texel][channel]));
      sum += irradiance[texel][channel];
    }
  }
  before_ = std::move(irradiance);
  return bound_on_missing(change, albedo_max_, sum / (3 * texels));
}

double split_half_error(std::span<const glm::vec4> irradiance, std::span<const glm::vec4> half_difference) {
  double squares = 0, sum = 0, values = 0;
  for (std::size_t texel = 0; texel < irradiance.size(); ++texel) {
    if (irradiance[texel].a == 0) continue;
    const glm::dvec3 apart(half_difference[texel]), light(irradiance[texel]);
    squares += glm::dot(apart, apart);
    sum += light.r + light.g + light.b;
    values += 3;
  }
  return sum > 0 ? std::sqrt(squares * values) / sum : 0;
}

}  // namespace lichtveld::lightfield
