#include "lamps.hpp"

#include <algorithm>
#include <cmath>

#include "lichtveld/scene/lights.hpp"

namespace lichtveld::reference {
namespace {

double mean(const glm::vec3& colour) {
  return (double{colour.r} + colour.g + colour.b) / 3;
}

}  // namespace

Lamps::Lamps(const Geometry& geometry) : geometry_(geometry) {
  double power = 0;
  for (const auto triangle : scene::emitting_triangles(geometry.scene())) {
    const double more = geometry.area(triangle) * mean(geometry.material(triangle).emission);
    if (!(more > 0)) continue;
    power += more;
    triangles_.push_back(triangle);
    power_up_to_.push_back(power);
  }
}

Hit Lamps::sample(glm::dvec2 random) const {
  const double at = random.x * power_up_to_.back();
  const auto chosen =
      std::min(std::upper_bound(power_up_to_.begin(), power_up_to_.end(), at), power_up_to_.end() - 1);
  const auto i = static_cast<std::size_t>(chosen - power_up_to_.begin());
  // Where within its share the number fell is uniform again: both dimensions stay stratified over the triangle.
  const double before = i > 0 ? power_up_to_[i - 1] : 0;
  const double again = std::clamp((at - before) / (*chosen - before), 0.0, 1.0);
  // Uniform over a triangle: Shirley et al. 1996, "Monte Carlo Techniques for Direct Lighting Calculations",
  // section 3.2.
  const double root = std::sqrt(again);
  return {triangles_[i], {root * (1 - random.y), root * random.y}};
}

double Lamps::density(std::uint32_t triangle) const {
  return none() ? 0 : mean(geometry_.material(triangle).emission) / power_up_to_.back();
}

}  // namespace lichtveld::reference
