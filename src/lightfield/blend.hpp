// blend: adds one direction's light to the bounce, and at a bounce's end makes it the total irradiance.
// Thesis, section 4.6. E = pi * sum_k w_k L_k / sum_k w_k; dividing by the weights that were met makes every
// row of the transport operator sum to one. Reads psf_irradiance, or bounce_irradiance; costs texels.
#pragma once

#include "light_map.hpp"

namespace lichtveld::lightfield {

class Blend {
 public:
  explicit Blend(const gpu::Device& device);
  void psf_into_bounce(gpu::Frame& frame, const LightMap& map) const;
  void bounce_into_total(gpu::Frame& frame, const LightMap& map) const;  // and clears the bounce

 private:
  gpu::ComputePipeline psf_, bounce_;
};

}  // namespace lichtveld::lightfield
