// Coordinates about a direction.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace lichtveld::lightfield {

// A right-handed frame about a unit vector: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
inline glm::mat3 frame_about(const glm::vec3& n) {
  const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {glm::vec3(1 + sign * n.x * n.x * a, sign * b, -sign * n.x), glm::vec3(b, sign + n.y * n.y * a, -n.y),
          n};
}

}  // namespace lichtveld::lightfield
