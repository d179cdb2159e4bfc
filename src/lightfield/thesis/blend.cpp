#include "thesis/blend.hpp"

#include "shaders/blend_bounce.comp.h"
#include "shaders/blend_psf.comp.h"

namespace lichtveld::lightfield {

BounceSums::BounceSums(const gpu::Device& device, std::uint32_t size)
    : lamp_irradiance(atlas_image(device, "lamp_irradiance", size, vk::Format::eR32G32B32A32Sfloat)),
      psf_irradiance(atlas_image(device, "psf_irradiance", size, vk::Format::eR32G32B32A32Sfloat)),
      bounce_irradiance{atlas_image(device, "bounce_irradiance 0", size, vk::Format::eR32G32B32A32Sfloat),
                        atlas_image(device, "bounce_irradiance 1", size, vk::Format::eR32G32B32A32Sfloat)} {}

Blend::Blend(const gpu::Device& device)
    : psf_(device, "blend", shaders::blend_psf_comp), bounce_(device, "blend", shaders::blend_bounce_comp) {}

void Blend::psf_into_bounce(gpu::Frame& frame, const BounceSums& sums, std::uint32_t half,
                            std::uint32_t groups) const {
  frame.compute(psf_,
                {gpu::reads("psf_irradiance", sums.psf_irradiance),
                 gpu::writes("bounce_irradiance", sums.bounce_irradiance[half])},
                groups, groups);
}

void Blend::bounce_into_total(gpu::Frame& frame, const BounceSums& sums, const LightMap& map) const {
  frame.compute(bounce_,
                {gpu::writes("bounce_irradiance_0", sums.bounce_irradiance[0]),
                 gpu::writes("bounce_irradiance_1", sums.bounce_irradiance[1]),
                 gpu::reads("lamp_irradiance", sums.lamp_irradiance), gpu::reads("position", map.position),
                 gpu::writes("total_irradiance", map.total_irradiance),
                 gpu::writes("half_difference", map.half_difference)},
                map.workgroups, map.workgroups);
}

}  // namespace lichtveld::lightfield
