// tone_map: radiance to what a browser shows: exposure from a log-luminance histogram over the valid texels,
// Reinhard's operator on luminance, sRGB. Thesis, section 4.7; Reinhard et al. 2002. Reads radiance,
// position and shown; writes presented. Costs texels, once a solve.
#pragma once

#include "passes/light_map.hpp"

namespace lichtveld::lightfield {

class ToneMap {
 public:
  explicit ToneMap(const gpu::Device& device);
  void record(gpu::Frame& frame, const LightMap& map) const;

 private:
  gpu::Buffer histogram_, exposure_;
  gpu::ComputePipeline count_, expose_, map_;
};

}  // namespace lichtveld::lightfield
