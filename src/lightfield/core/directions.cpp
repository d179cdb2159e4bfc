#include "lichtveld/lightfield/directions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>

#include "shared.h"

namespace lichtveld::lightfield {

namespace {

using Point = glm::dvec3;
using std::numbers::pi;

constexpr std::array<std::uint32_t, 10> counts = {8, 24, 32, 96, 128, 384, 512, 1536, 2048, 6144};

// The octahedron's upper half; the lower is its image through the centre.
const Point top(0, 0, 1);
const std::array<Point, 4> equator = {Point(1, 0, 0), Point(0, 1, 0), Point(-1, 0, 0), Point(0, -1, 0)};

// Van Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle", equation 8, for unit vectors.
double solid_angle(const Point& a, const Point& b, const Point& c) {
  const double numerator = std::abs(glm::dot(a, glm::cross(b, c)));
  const double denominator = 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a);
  return 2 * std::atan2(numerator, denominator);
}

// A part of the sphere and its middle.
struct Cell {
  Point middle;
  double solid_angle;
};

// Two triangles joined along a-b: the rhombus (a, left, b, right), cut into 4^depth like it.
void cut_rhombus(const Point& a, const Point& left, const Point& b, const Point& right, int depth,
                 std::vector<Cell>& cells) {
  const Point middle = glm::normalize(a + b);
  if (depth == 0) {
    cells.push_back({middle, solid_angle(a, left, b) + solid_angle(b, right, a)});
    return;
  }
  const Point al = glm::normalize(a + left), lb = glm::normalize(left + b), br = glm::normalize(b + right),
              ra = glm::normalize(right + a);
  cut_rhombus(a, al, middle, ra, depth - 1, cells);
  cut_rhombus(al, left, lb, middle, depth - 1, cells);
  cut_rhombus(middle, lb, b, br, depth - 1, cells);
  cut_rhombus(ra, middle, br, right, depth - 1, cells);
}

// A triangle's thirds meet the neighbours' along its edges: a cell an edge of the triangulation. Neighbours
// compute the middle of a shared edge from the same two points, so that it is the same to the bit.
using Edges = std::map<std::array<double, 3>, double>;  // middle -> solid angle

void cut_triangle(const Point& a, const Point& b, const Point& c, int depth, Edges& edges) {
  const Point ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
  if (depth == 0) {
    const Point centre = glm::normalize(a + b + c);
    edges[{ab.x, ab.y, ab.z}] += solid_angle(a, b, centre);
    edges[{bc.x, bc.y, bc.z}] += solid_angle(b, c, centre);
    edges[{ca.x, ca.y, ca.z}] += solid_angle(c, a, centre);
    return;
  }
  cut_triangle(a, ab, ca, depth - 1, edges);
  cut_triangle(ab, b, bc, depth - 1, edges);
  cut_triangle(ca, bc, c, depth - 1, edges);
  cut_triangle(ab, bc, ca, depth - 1, edges);
}

// count / 4 cells that cover the sphere together with their antipodes.
std::vector<Cell> half_set(std::uint32_t count) {
  const bool thirds = count % 24 == 0;
  int depth = 0;
  for (auto triangles = thirds ? count / 24 : count / 8; triangles > 1; triangles /= 4) ++depth;
  std::vector<Cell> cells;
  if (thirds) {
    Edges edges;
    for (int side = 0; side < 4; ++side)
      cut_triangle(equator[side], equator[(side + 1) % 4], top, depth, edges);
    for (const auto& [middle, share] : edges) {
      const Point at(middle[0], middle[1], middle[2]);
      // Cells on the equator reach as far below it, and have their antipodes among themselves.
      if (at.z > 0)
        cells.push_back({at, share});
      else if (at.y > 0)
        cells.push_back({at, 2 * share});
    }
  } else {
    for (int side = 0; side < 2; ++side)  // those of the other two sides are their antipodes
      cut_rhombus(equator[side], top, equator[side + 1], -top, depth, cells);
  }
  return cells;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  double next() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }  // 0..1, the same on every platform

 private:
  std::mt19937_64 bits_;
};

// Shoemake 1992, "Uniform Random Rotations", Graphics Gems III, section III.6.
glm::dquat random_rotation(Random& random) {
  const double u = random.next(), a = 2 * pi * random.next(), b = 2 * pi * random.next();
  return {std::sqrt(u) * std::cos(b), std::sqrt(1 - u) * std::sin(a), std::sqrt(1 - u) * std::cos(a),
          std::sqrt(u) * std::sin(b)};
}

}  // namespace

std::span<const std::uint32_t> direction_counts() {
  return counts;
}

std::string direction_counts_text() {
  std::string text;
  for (const auto count : counts) text += (text.empty() ? "" : ", ") + std::to_string(count);
  return text;
}

DirectionSet::DirectionSet(std::uint32_t count, Weights weights, std::uint64_t seed) {
  if (std::find(counts.begin(), counts.end(), count) == counts.end())
    throw std::invalid_argument(std::to_string(count) + " PSFs: the direction sets have " +
                                direction_counts_text());
  const auto cells = half_set(count);
  Random random(seed);
  for (std::uint32_t half = 0; half < 2; ++half) {
    const glm::dquat rotation = random_rotation(random);
    for (const Cell& cell : cells) {
      const double share = weights == Weights::equal ? 4 * pi / count : cell.solid_angle / 2;
      const double roll = 2 * pi * random.next(), x = random.next() - 0.5, y = random.next() - 0.5;
      all_.push_back({.along = glm::vec3(rotation * cell.middle),
                      .solid_angle = static_cast<float>(share),
                      .half = half,
                      .roll = static_cast<float>(roll),
                      .jitter = {x, y}});
    }
  }
  // Of either half the parts are interleaved.
  constexpr std::size_t parts_of_half = parts / 2;
  const std::size_t half = count / 4;
  for (const std::size_t first : {std::size_t{0}, half})
    for (std::size_t part = 0; part < parts_of_half; ++part)
      for (auto index = part; index < half; index += parts_of_half) pairs_.push_back(all_[first + index]);
  for (std::size_t index = 0; index < count / 2; ++index) {
    all_.push_back(all_[index]);
    all_.back().along = -all_.back().along;
  }
}

Range DirectionSet::half(std::uint32_t index) const {
  const auto each = size() / 4;
  return {index * each, (index + 1) * each};
}

Range DirectionSet::part(std::uint32_t index) const {
  const auto pairs = static_cast<std::uint32_t>(pairs_.size());
  return {shaders::first_pair_of_part(pairs, index), shaders::first_pair_of_part(pairs, index + 1)};
}

static_assert(DirectionSet::parts == shaders::PARTS);

}  // namespace lichtveld::lightfield
