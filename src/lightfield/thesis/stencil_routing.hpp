// stencil_routing: for each texel, order the layers of the pixel it projects to and find the last one in front
// of it. Thesis, section 4.5. Depths are compared where the ray through the pixel's centre meets the texel's
// plane. Reads the A-buffer and the texels' positions and normals; writes `psf_irradiance` (w_k L_k and w_k).
// Costs texels times layers; the sort is chosen by Settings::sort.
#pragma once

#include "thesis/blend.hpp"
#include "thesis/emit_radiance.hpp"

namespace lichtveld::lightfield {

class StencilRouting {
 public:
  StencilRouting(const gpu::Device& device, const LayerStore& store, Sort sort);

  // If `count` is set, rays and misses are counted into `counters`, and what lies in contact into `cover`.
  void record(gpu::Frame& frame, const shaders::PsfView& view, const LayerStore& store,
              const Geometry& geometry, const LightMap& map, const BounceSums& sums, bool count,
              const gpu::Buffer& counters) const;

 private:
  gpu::ComputePipeline route_;
};

// Layer `layer` of each pixel in the order of arrival into `shown` (rgb: radiance, a: depth), for dumps.
class ShowLayer {
 public:
  ShowLayer(const gpu::Device& device, const LayerStore& store);
  void record(gpu::Frame& frame, const LayerStore& store, std::uint32_t layer, const gpu::Image& shown) const;

 private:
  gpu::ComputePipeline show_;
};

}  // namespace lichtveld::lightfield
