// brdf: irradiance to what the next bounce emits, L = Le + albedo / pi * E.
// Thesis, section 4.6. Reads source, albedo, emission, total_irradiance; writes radiance, gutters too, so that
// bilinear sampling at a chart's edge finds the chart's own light. Costs texels.
#pragma once

#include "passes/light_map.hpp"

namespace lichtveld::lightfield {

class Brdf {
 public:
  explicit Brdf(const gpu::Device& device);
  // `emitted`: whether Le counts, or is known apart.
  void record(gpu::Frame& frame, const LightMap& map, bool emitted = true) const;

 private:
  gpu::ComputePipeline reflect_;
};

}  // namespace lichtveld::lightfield
