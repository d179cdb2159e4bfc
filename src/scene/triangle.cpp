#include "triangle.hpp"

#include <algorithm>

namespace lichtveld::scene {

glm::dvec3 cross_of(const Corners& corners) {
  const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
  return glm::cross(b - a, c - a);
}

double area_of(const Corners& corners) {
  return glm::length(cross_of(corners)) / 2;
}

bool has_area(const Corners& corners) {
  constexpr double flat_share = 1e-7;
  const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
  const double longest = std::max({glm::dot(b - a, b - a), glm::dot(c - a, c - a), glm::dot(c - b, c - b)});
  return glm::length(cross_of(corners)) > flat_share * longest;
}

bool are_copies(const Corners& a, const Corners& b) {
  for (std::size_t turn = 0; turn < 3; ++turn)
    if (a[0] == b[turn] && a[1] == b[(turn + 1) % 3] && a[2] == b[(turn + 2) % 3]) return true;
  return false;
}

}  // namespace lichtveld::scene
