// geometry_texture: each triangle drawn at its place in the atlas, so that a texel knows its surface point.
// Thesis, section 4.2. Reads the geometry; writes position, normals, albedo, emission, then `source`, which
// names for each gutter texel its nearest chart texel. Costs atlas texels, once a solve.
#pragma once

#include "light_map.hpp"

namespace lichtveld::lightfield {

class GeometryTexture {
 public:
  explicit GeometryTexture(const gpu::Device& device);
  void record(gpu::Frame& frame, const Geometry& geometry, const LightMap& map) const;

 private:
  gpu::GraphicsPipeline draw_;
  gpu::ComputePipeline gutter_;
};

}  // namespace lichtveld::lightfield
