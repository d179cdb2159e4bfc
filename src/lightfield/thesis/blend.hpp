// blend: adds one direction's light to the bounce, and at a bounce's end makes it the total irradiance.
// Thesis, section 4.6. E = pi * sum_k w_k L_k / sum_k w_k; dividing by the weights that were met makes every
// row of the transport operator sum to one. The two halves of the directions are summed apart, so that their
// disagreement tells the error. Reads psf_irradiance, or bounce_irradiance; costs texels.
#pragma once

#include <array>

#include "passes/light_map.hpp"

namespace lichtveld::lightfield {

// What a bounce adds up, in atlas space: as LightMap's images.
struct BounceSums {
  BounceSums(const gpu::Device& device, std::uint32_t size);

  gpu::Image lamp_irradiance;                   // rgb: E straight from lamps where it is exact [W m^-2]; or 0
  gpu::Image psf_irradiance;                    // rgb: w_k L_k [W m^-2]; a: w_k [sr]; of one direction
  std::array<gpu::Image, 2> bounce_irradiance;  // their sums over each half of the directions
};

class Blend {
 public:
  explicit Blend(const gpu::Device& device);
  // `half`: which of the bounce's two sums the direction belongs to; `groups`: LightMap::workgroups.
  void psf_into_bounce(gpu::Frame& frame, const BounceSums& sums, std::uint32_t half,
                       std::uint32_t groups) const;
  // Both halves and the exact light of lamps into total_irradiance, the halves' disagreement into
  // half_difference; clears the bounce.
  void bounce_into_total(gpu::Frame& frame, const BounceSums& sums, const LightMap& map) const;

 private:
  gpu::ComputePipeline psf_, bounce_;
};

}  // namespace lichtveld::lightfield
