// geometry_texture: each triangle drawn at its place in the atlas, so that a texel knows its surface point.
// Thesis, section 4.2. Reads the geometry; writes position, normals, albedo, emission, then what stands
// near each texel, and `source`, which names for each gutter texel its nearest chart texel. Costs atlas texels,
// once a solve.
#pragma once

#include "light_map.hpp"

namespace lichtveld::lightfield {

class GeometryTexture {
 public:
  explicit GeometryTexture(const gpu::Device& device);
  void record(gpu::Frame& frame, const Geometry& geometry, const LightMap& map) const;
  // Writes `source` from the charts, which do not move in the atlas.
  void find_sources(gpu::Frame& frame, const LightMap& map) const;
  // Writes `shown` from the charts and `cover`: like `source`, but a texel that other geometry lies on shows
  // its nearest open one too, so that filtering does not draw its black out along that geometry's foot.
  void find_shown(gpu::Frame& frame, const LightMap& map) const;

 private:
  gpu::GraphicsPipeline draw_;
  void name_sources(gpu::Frame& frame, const LightMap& map, bool covered, const gpu::Image& sources) const;

  gpu::ComputePipeline walls_, gutter_;
};

}  // namespace lichtveld::lightfield
