#include "thesis/blend.hpp"

#include "shaders/blend_bounce.comp.h"
#include "shaders/blend_psf.comp.h"

namespace lichtveld::lightfield {

BounceSums::BounceSums(const gpu::Device& device, std::uint32_t size)
    : psf_irradiance(atlas_image(device, "psf_irradiance", size, vk::Format::eR32G32B32A32Sfloat)),
      bounce_irradiance{atlas_image(device, "bounce_irradiance 0", size, vk::Format::eR32G32B32A32Sfloat),
                        atlas_image(device, "bounce_irradiance 1", size, vk::Format::eR32G32B32A32Sfloat)} {}

Blend::Blend(const gpu::Device& device)
    : psf_(device, "blend", blend_psf_comp, {.kinds = std::vector(2, gpu::Kind::storage_image)}),
      bounce_(device, "blend", blend_bounce_comp, {.kinds = std::vector(5, gpu::Kind::storage_image)}) {}

void Blend::psf_into_bounce(gpu::Frame& frame, const BounceSums& sums, std::uint32_t half,
                            std::uint32_t groups) const {
  frame.compute(psf_, {gpu::reads(sums.psf_irradiance), gpu::writes(sums.bounce_irradiance[half])}, groups,
                groups);
}

void Blend::bounce_into_total(gpu::Frame& frame, const BounceSums& sums, const LightMap& map) const {
  frame.compute(bounce_,
                {gpu::writes(sums.bounce_irradiance[0]), gpu::writes(sums.bounce_irradiance[1]),
                 gpu::reads(map.position), gpu::writes(map.total_irradiance), gpu::writes(map.half_difference)},
                map.groups, map.groups);
}

}  // namespace lichtveld::lightfield
