// Surfaces laid flat: pieces of a mesh that a light map can show, each in a plane of its own.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "triangle.hpp"

namespace lichtveld::scene {

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

}  // namespace lichtveld::scene
