#include "thesis/blend.hpp"

#include "shaders/blend_bounce.comp.h"
#include "shaders/blend_psf.comp.h"

namespace lichtveld::lightfield {

Blend::Blend(const gpu::Device& device)
    : psf_(device, "blend", blend_psf_comp, {.kinds = std::vector(2, gpu::Kind::storage_image)}),
      bounce_(device, "blend", blend_bounce_comp, {.kinds = std::vector(5, gpu::Kind::storage_image)}) {}

void Blend::psf_into_bounce(gpu::Frame& frame, const LightMap& map, std::uint32_t half) const {
  frame.compute(psf_, {gpu::reads(map.psf_irradiance), gpu::writes(map.bounce_irradiance[half])}, map.groups,
                map.groups);
}

void Blend::bounce_into_total(gpu::Frame& frame, const LightMap& map) const {
  frame.compute(bounce_,
                {gpu::writes(map.bounce_irradiance[0]), gpu::writes(map.bounce_irradiance[1]),
                 gpu::reads(map.position), gpu::writes(map.total_irradiance), gpu::writes(map.half_difference)},
                map.groups, map.groups);
}

}  // namespace lichtveld::lightfield
