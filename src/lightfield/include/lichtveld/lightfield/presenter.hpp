// Irradiance as players would see it.
#pragma once

#include <span>
#include <vector>

#include "lichtveld/gpu/device.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

// Tone-maps the radiance that follows from an irradiance computed elsewhere: `irradiance` has size * size
// texels (rgb: E [W m^-2]), bodies are shifted by offsets [m], one entry a body. Returns sRGB RGBA, row 0 on
// top, gutters dilated.
std::vector<std::uint8_t> present(const gpu::Device& device, const scene::Scene& scene, std::uint32_t size,
                                  const std::vector<glm::vec3>& offsets, std::span<const glm::vec4> irradiance);

}  // namespace lichtveld::lightfield
