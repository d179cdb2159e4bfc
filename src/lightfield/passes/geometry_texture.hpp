// geometry_texture: each triangle drawn at its place in the atlas, so that a texel knows its surface point.
// Thesis, section 4.2. Reads the geometry; writes position and normals, then what stands near each texel.
// Albedo and emission do not move, and come from TexelRecords. Costs the texels of what has moved, and a look
// at each other one. Which texels are valid and what they are TexelRecords knows; this has it on the device,
// where the bodies are now.
#pragma once

#include "passes/light_map.hpp"

namespace lichtveld::lightfield {

class GeometryTexture {
 public:
  explicit GeometryTexture(const gpu::Device& device);
  // Draws what has moved where it is now: into a map that holds the rest, or all of it.
  void record(gpu::Frame& frame, const Geometry& geometry, const LightMap& map, const Moves& moves) const;
  // Writes `near_walls` from those that the geometry has found.
  void find_walls(gpu::Frame& frame, const Geometry& geometry, const LightMap& map) const;
  // Writes `shown` from the charts, `source` and `cover`: like `source`, but a texel that other geometry lies
  // on shows its nearest open one too, so that filtering does not draw its black out along that geometry's
  // foot.
  void find_shown(gpu::Frame& frame, const LightMap& map) const;

 private:
  gpu::GraphicsPipeline draw_;
  gpu::ComputePipeline walls_, gutter_;
};

}  // namespace lichtveld::lightfield
