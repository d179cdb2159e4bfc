// Round and awkward shapes for SceneBuilder, each with charts that do not overlap.
#pragma once

#include <cmath>
#include <numbers>

#include "scene_builder.hpp"

namespace lichtveld::testing {

// A horizontal disc that faces down, a polygon of 1000 corners standing for round. It fills the chart's
// inscribed circle.
inline int disc(SceneBuilder& builder, const std::string& name, glm::vec3 centre, float radius, Chart c,
                int material) {
  constexpr int corners = 1000;
  const glm::vec2 middle{(c.u0 + c.u1) / 2, (c.v0 + c.v1) / 2};
  const float chart_radius = std::min(c.u1 - c.u0, c.v1 - c.v0) / 2;
  std::vector<glm::vec3> positions{centre};
  std::vector<glm::vec2> atlas{middle};
  std::vector<std::uint16_t> indices;
  for (int k = 0; k < corners; ++k) {
    const auto angle = static_cast<float>(2 * std::numbers::pi * k / corners);
    const glm::vec2 round{std::cos(angle), std::sin(angle)};
    positions.emplace_back(centre.x + radius * round.x, centre.y, centre.z + radius * round.y);
    atlas.emplace_back(middle + chart_radius * round);
    for (const int i : {0, 1 + k, 1 + (k + 1) % corners}) indices.push_back(static_cast<std::uint16_t>(i));
  }
  return builder.mesh(name, positions, atlas, indices, material);
}

// The horizontal square |x|, |z| <= half at height y as a fan of `slivers` triangles with a common corner and
// one without area after each. The chart's u runs along x.
inline int sliver_square(SceneBuilder& builder, const std::string& name, float y, bool down, Chart c,
                         int material, int slivers) {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec2> atlas;
  std::vector<std::uint16_t> indices;
  const auto add = [&](glm::vec2 at) {  // 0..1 along x and z
    positions.emplace_back(2 * at.x - 1, y, 2 * at.y - 1);
    atlas.emplace_back(c.u0 + at.x * (c.u1 - c.u0), c.v0 + at.y * (c.v1 - c.v0));
  };
  add({0, 0});
  for (int k = 0; k <= slivers; ++k) {  // along the two far sides of the square
    const float at = 2 * static_cast<float>(k) / static_cast<float>(slivers);
    add({std::min(at, 1.0f), std::min(2 - at, 1.0f)});
  }
  for (int k = 1; k <= slivers; ++k) {
    // From x = 0 on: (0, 0), (0, 1), (x, 1) turns counter-clockwise as seen from above.
    const int a = down ? k + 1 : k, b = down ? k : k + 1;
    for (const int i : {0, a, b, a, b, a}) indices.push_back(static_cast<std::uint16_t>(i));
  }
  return builder.mesh(name, positions, atlas, indices, material);
}

// A sphere about the origin as a cube of 6 x cells x cells bulged quads, each of two triangles. The faces'
// charts are cells of a 3 x 3 grid in `chart` with gutters of 1/16 cell on every side; `cap_material` has the
// middle 4 x 4 quads of the top, in the grid's seventh cell, unless it is -1.
inline void sphere(SceneBuilder& builder, const std::string& name, float radius, int cells, bool inwards,
                   Chart chart, int material, int cap_material = -1) {
  constexpr int cap_quads = 4;  // a side
  struct Part {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> atlas;
    std::vector<std::uint16_t> indices;
  } body, cap;
  // Tangents spread the quads evenly over the angle.
  const auto spread = [&](int k) {
    return std::tan(static_cast<float>(std::numbers::pi / 4) * (2 * static_cast<float>(k) / cells - 1));
  };
  const glm::vec2 grid{(chart.u1 - chart.u0) / 3, (chart.v1 - chart.v0) / 3};
  for (int face = 0; face < 6; ++face)
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        const auto middle = [&](int k) { return 2 * k >= cells - cap_quads && 2 * k < cells + cap_quads; };
        const bool in_cap = cap_material >= 0 && face == 3 && middle(i) && middle(j);
        Part& part = in_cap ? cap : body;
        const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3, place = in_cap ? 6 : face;
        const bool far = face % 2;
        const auto first = static_cast<std::uint16_t>(part.positions.size());
        for (const glm::ivec2 corner :
             {glm::ivec2(0, 0), glm::ivec2(1, 0), glm::ivec2(1, 1), glm::ivec2(0, 1)}) {
          glm::vec3 p;
          p[axis] = far ? 1.0f : -1.0f;
          p[u] = spread(i + corner.x);
          p[v] = spread(j + corner.y);
          part.positions.push_back(radius * glm::normalize(p));
          const int from = in_cap ? (cells - cap_quads) / 2 : 0, across = in_cap ? cap_quads : cells;
          const glm::vec2 at = glm::vec2(glm::ivec2(i, j) + corner - from) / static_cast<float>(across);
          part.atlas.push_back(glm::vec2(chart.u0, chart.v0) +
                               grid * (glm::vec2(place % 3, place / 3) + 1.0f / 16 + at * (14.0f / 16)));
        }
        for (const int k : far != inwards ? std::array{0, 1, 2, 0, 2, 3} : std::array{0, 2, 1, 0, 3, 2})
          part.indices.push_back(static_cast<std::uint16_t>(first + k));
      }
  builder.mesh(name, body.positions, body.atlas, body.indices, material);
  if (cap_material >= 0) builder.mesh(name + "'s cap", cap.positions, cap.atlas, cap.indices, cap_material);
}

}  // namespace lichtveld::testing
