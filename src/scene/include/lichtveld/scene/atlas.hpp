// The light map's atlas: which texels lie on a surface, and where.
#pragma once

#include "lichtveld/scene/surface_point.hpp"

namespace lichtveld::scene {

struct AtlasTexel {
  std::uint32_t index;  // row * size + column
  SurfacePoint at;      // its centre, which snapping may have put a hair outside of the triangle
};

// The valid texels of an atlas of size * size, by index: those whose centre lies on a chart, by the rules of
// graphics hardware. What is valid is decided here, for every method; geometry_texture draws the same ones.
std::vector<AtlasTexel> valid_texels(const Scene& scene, std::uint32_t size);

// Checks the atlas at size * size texels: throws SceneError that names the charts that overlap and how many
// texels they share, or that no texel is covered at all. Returns the number of valid texels.
std::uint32_t check_atlas(const Scene& scene, std::uint32_t size);

}  // namespace lichtveld::scene
