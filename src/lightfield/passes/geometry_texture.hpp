// geometry_texture: each triangle drawn at its place in the atlas, so that a texel knows its surface point.
// Thesis, section 4.2. Reads the geometry; writes position, normals, albedo, emission, then what stands
// near each texel, and `source`, which names for each gutter texel its nearest chart texel. Costs the texels of
// what has moved, and a look at each other one.
#pragma once

#include "passes/light_map.hpp"

namespace lichtveld::lightfield {

class GeometryTexture {
 public:
  explicit GeometryTexture(const gpu::Device& device);
  // Draws what is not yet in `map`, always the same, where it is now.
  void record(gpu::Frame& frame, const Geometry& geometry, const LightMap& map);
  // Writes `source` from the charts, which do not move in the atlas.
  void find_sources(gpu::Frame& frame, const LightMap& map) const;
  // Writes `shown` from the charts, `source` and `cover`: like `source`, but a texel that other geometry lies
  // on shows its nearest open one too, so that filtering does not draw its black out along that geometry's
  // foot.
  void find_shown(gpu::Frame& frame, const LightMap& map) const;

 private:
  void name_sources(gpu::Frame& frame, const LightMap& map, bool covered, const gpu::Image& found) const;

  gpu::GraphicsPipeline draw_;
  gpu::ComputePipeline walls_, gutter_;
  std::vector<glm::vec3>
      drawn_;  // shifts of the bodies as they are in the map [m]; empty before the first time
};

}  // namespace lichtveld::lightfield
