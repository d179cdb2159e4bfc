#include "lichtveld/lightfield/directions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace lichtveld::lightfield {

namespace {

using Point = glm::dvec3;

constexpr std::array<std::uint32_t, 10> counts = {8, 24, 32, 96, 128, 384, 512, 1536, 2048, 6144};

// Van Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle", equation 8, for unit vectors.
double solid_angle(const Point& a, const Point& b, const Point& c) {
  const double numerator = std::abs(glm::dot(a, glm::cross(b, c)));
  const double denominator = 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a);
  return 2 * std::atan2(numerator, denominator);
}

struct Sampler {
  bool three_a_triangle;
  std::vector<Direction> found;

  void add(const Point& a, const Point& b, const Point& c) {
    found.push_back({glm::vec3(glm::normalize(a + b + c)), static_cast<float>(solid_angle(a, b, c))});
  }

  void subdivide(const Point& a, const Point& b, const Point& c, int depth) {
    if (depth > 0) {
      const Point ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
      subdivide(a, ab, ca, depth - 1);
      subdivide(ab, b, bc, depth - 1);
      subdivide(ca, bc, c, depth - 1);
      subdivide(ab, bc, ca, depth - 1);
    } else if (three_a_triangle) {
      const Point centre = glm::normalize(a + b + c);
      add(a, b, centre);
      add(b, c, centre);
      add(c, a, centre);
    } else {
      add(a, b, c);
    }
  }
};

}  // namespace

std::span<const std::uint32_t> direction_counts() {
  return counts;
}

std::string direction_counts_text() {
  std::string text;
  for (const auto count : counts) text += (text.empty() ? "" : ", ") + std::to_string(count);
  return text;
}

std::vector<Direction> directions(std::uint32_t count) {
  if (std::find(counts.begin(), counts.end(), count) == counts.end())
    throw std::invalid_argument(std::to_string(count) + " PSFs: the direction sets have " +
                                direction_counts_text());
  Sampler sampler{.three_a_triangle = count % 24 == 0, .found = {}};
  int depth = 0;
  for (std::uint32_t triangles = sampler.three_a_triangle ? count / 24 : count / 8; triangles > 1;
       triangles /= 4)
    ++depth;
  // The octahedron's upper half; the lower is its mirror image through the centre.
  const Point top(0, 0, 1);
  const std::array<Point, 4> equator = {Point(1, 0, 0), Point(0, 1, 0), Point(-1, 0, 0), Point(0, -1, 0)};
  for (int side = 0; side < 4; ++side) sampler.subdivide(equator[side], equator[(side + 1) % 4], top, depth);
  auto& found = sampler.found;
  const auto half = found.size();
  for (std::size_t index = 0; index < half; ++index)
    found.push_back({-found[index].along, found[index].solid_angle});
  return std::move(found);
}

}  // namespace lichtveld::lightfield
