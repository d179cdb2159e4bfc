// Irradiance as players would see it.
#pragma once

#include "lichtveld/gpu/device.hpp"
#include "lichtveld/lightfield/shown.hpp"
#include "lichtveld/lightfield/texel_view.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

// Tone-maps the radiance that follows from an irradiance wherever it was computed (rgb: E [W m^-2]), as wide as
// the atlas.
Shown present(const gpu::Device& device, const scene::Scene& scene, const TexelView& irradiance);

}  // namespace lichtveld::lightfield
