// Surfaces laid flat: pieces of a mesh that a light map can show, each in a plane of its own.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lichtveld::scene {

using Corners = std::array<glm::vec3, 3>;

// A piece whose triangles do not overlap in its plane.
struct Chart {
  std::vector<std::uint32_t> triangles;         // numbers in the list that was laid flat
  std::vector<std::array<glm::dvec2, 3>> flat;  // each one's corners [m]; the least are 0
  glm::dvec2 extent{0};                         // [m]
};

struct ChartLimits {
  double cell = 0;     // two places of a chart that are nearer to each other may coincide in it [m], > 0
  double longest = 0;  // no chart of several triangles is longer [m]
};

// Which triangles lie on each other with the same corners in the same order: each one's first such, itself for
// most, and by how many corners it is turned against that.
struct Twins {
  std::vector<std::uint32_t> first;
  std::vector<std::uint8_t> turn;
};

// The pieces of these triangles (world or mesh space, [m]) that face nearly one way, laid flat along it and
// turned so that they fill much of their rectangles. Takes time that is nearly proportional to the triangles
// and the cells that they fill, and gives the same for the same. Copies of a triangle lie in one place; those
// without area lie nowhere.
std::vector<Chart> find_charts(std::span<const Corners> triangles, const ChartLimits& limits);

// The pieces that `uv`, a coordinate for each corner, joins: as they are there, but as large as their surfaces.
// Those that fold onto themselves, that have no area there or no finite place, are laid flat by find_charts;
// their triangles are counted in `anew`.
std::vector<Chart> charts_of(std::span<const Corners> triangles, std::span<const std::array<glm::vec2, 3>> uv,
                             const ChartLimits& limits, std::size_t& anew);

// For each triangle the piece that it is of, where pieces hang together by edges, and whether each piece is
// closed: every edge runs both ways equally often, and more space is inside than outside.
struct Bodies {
  std::vector<std::uint32_t> of;
  std::vector<bool> closed;
  std::vector<Corners::value_type> min, max;  // of each [m]
};
Bodies find_bodies(std::span<const Corners> triangles);

// The area of a triangle [m2].
double area_of(const Corners& corners);

}  // namespace lichtveld::scene
