#include "core/psf_view.hpp"

#include <cmath>

namespace lichtveld::lightfield {

shaders::PsfView psf_view(const Direction& direction, const scene::Sphere& sphere, std::uint32_t pixels) {
  // Duff et al. 2017, "Building an Orthonormal Basis, Revisited": right x up = along.
  const glm::vec3 n = direction.along;
  const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  const glm::vec3 x(1 + sign * n.x * n.x * a, sign * b, -sign * n.x), y(b, sign + n.y * n.y * a, -n.y);
  const float cosine = std::cos(direction.roll), sine = std::sin(direction.roll);
  const float pixel = 2.0f / static_cast<float>(pixels), scale = (1 - pixel / 2) / sphere.radius;
  const auto row = [&](const glm::vec3& axis, float shift) {
    return glm::vec4(axis * scale, shift - glm::dot(axis, sphere.centre) * scale);
  };
  return {.right = row(cosine * x + sine * y, direction.jitter.x * pixel),
          .up = row(cosine * y - sine * x, direction.jitter.y * pixel),
          .along = row(n, 0),
          .direction = glm::vec4(n, direction.solid_angle)};
}

}  // namespace lichtveld::lightfield
