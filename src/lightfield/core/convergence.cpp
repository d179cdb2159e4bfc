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

Convergence::Convergence(const gpu::Device& device, const LightMap& map)
    : before_(std::size_t{map.size} * map.size, glm::vec4(0)) {
  const auto positions = gpu::download<glm::vec4>(device, map.position);
  const auto albedos = gpu::download<glm::vec4>(device, map.albedo);
  for (std::size_t texel = 0; texel < positions.size(); ++texel) {
    if (positions[texel].a == 0) continue;
    ++texels_valid_;
    albedo_max_ = std::max({albedo_max_, albedos[texel].r, albedos[texel].g, albedos[texel].b});
  }
}

double Convergence::measure(const gpu::Device& device, const LightMap& map) {
  auto now = gpu::download<glm::vec4>(device, map.total_irradiance);
  double change = 0, sum = 0;
  for (std::size_t texel = 0; texel < now.size(); ++texel) {
    if (now[texel].a == 0) continue;
    for (int channel = 0; channel < 3; ++channel) {
      change = std::max(change, std::abs(double{now[texel][channel]} - before_[texel][channel]));
      sum += now[texel][channel];
    }
  }
  before_ = std::move(now);
  return bound_on_missing(change, albedo_max_, sum / (3.0 * texels_valid_));
}

double split_half_error(const gpu::Device& device, const LightMap& map) {
  const auto total = gpu::download<glm::vec4>(device, map.total_irradiance);
  const auto difference = gpu::download<glm::vec4>(device, map.half_difference);
  double squares = 0, sum = 0, values = 0;
  for (std::size_t texel = 0; texel < total.size(); ++texel) {
    if (total[texel].a == 0) continue;
    const glm::dvec3 apart(difference[texel]), light(total[texel]);
    squares += glm::dot(apart, apart);
    sum += light.r + light.g + light.b;
    values += 3;
  }
  return sum > 0 ? std::sqrt(squares * values) / sum : 0;
}

}  // namespace lichtveld::lightfield
