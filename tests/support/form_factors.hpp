// Form factors that tests compare with: Howell, A Catalog of Radiation Heat Transfer Configuration Factors.
#pragma once

#include <cmath>
#include <numbers>

namespace lichtveld::testing {

// Squares of the unit cube (Howell C-11, C-14): opposite ones, and two with a common edge.
constexpr double parallel_squares = 0.199825, perpendicular_squares = 0.200044;

// From a point to a parallel rectangle whose corner lies on the point's normal (Howell, B-3), sides a and b at
// distance c, signed.
inline double corner_factor(double a, double b, double c) {
  const double x = a / c, y = b / c, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * std::numbers::pi);
}

// From the point (x, z) to the rectangle |x| <= half_x, |z| <= half_z at distance c.
inline double rectangle_factor(double x, double z, double half_x, double half_z, double c) {
  return corner_factor(half_x - x, half_z - z, c) - corner_factor(-half_x - x, half_z - z, c) -
         corner_factor(half_x - x, -half_z - z, c) + corner_factor(-half_x - x, -half_z - z, c);
}

}  // namespace lichtveld::testing
