// How far one light map is from another, as the project reports it.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <span>

namespace lichtveld::testing {

// sqrt(mean((E - Eref)^2)) / mean(Eref) over the reference's valid texels (alpha > 0), channels together.
inline double rel_rmse(std::span<const glm::vec4> irradiance, std::span<const glm::vec4> reference) {
  double squares = 0, sum = 0;
  std::size_t values = 0;
  for (std::size_t texel = 0; texel < reference.size(); ++texel) {
    if (reference[texel].a == 0) continue;
    for (int channel = 0; channel < 3; ++channel) {
      const double difference = double{irradiance[texel][channel]} - reference[texel][channel];
      squares += difference * difference;
      sum += reference[texel][channel];
    }
    values += 3;
  }
  return std::sqrt(squares / static_cast<double>(values)) / (sum / static_cast<double>(values));
}

}  // namespace lichtveld::testing
