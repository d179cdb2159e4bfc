// Charts' places in a light map's atlas.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "charts.hpp"
#include "lichtveld/scene/scene.hpp"
#include "pack.hpp"

namespace lichtveld::scene {

inline constexpr std::uint32_t gutter = 2;  // texels between charts

// A chart of a node in the atlas.
struct Spot {
  const Chart* chart = nullptr;
  double scale = 0;  // from the mesh's metres to the node's, times its density
};

struct Atlas {
  std::uint32_t size = 0;
  double density = 0;                 // texels a metre
  std::vector<Rectangle> rectangles;  // of each spot, with its gutter
};

// The smallest atlas from `options.size` on that holds all charts, as dense as can be or as is wanted. Throws
// SceneError where none does.
Atlas packed(const std::vector<Spot>& spots, const UnwrapOptions& options);

// A place of a chart in the atlas, 0..1. One that is only a texel wide or high is moved, into its gutter if
// need be, so that the middle of its first triangle, its largest, lies on texels' centres: it would hold none
// otherwise.
glm::vec2 in_atlas(const Chart& chart, const Rectangle& rectangle, const glm::dvec2& place, std::uint32_t size);

// The share of the atlas that charts fill, 0..1.
double coverage_of(const Atlas& atlas);

}  // namespace lichtveld::scene
