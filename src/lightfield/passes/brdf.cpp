#include "passes/brdf.hpp"

#include "shaders/brdf.comp.h"
#include "shared.h"

namespace lichtveld::lightfield {

Brdf::Brdf(const gpu::Device& device) : reflect_(device, "brdf", shaders::brdf_comp) {}

void Brdf::record(gpu::Frame& frame, const LightMap& map, bool emitted) const {
  frame.compute(
      reflect_,
      {gpu::reads("source", map.source), gpu::reads("albedo", map.albedo), gpu::reads("emission", map.emission),
       gpu::reads("total_irradiance", map.total_irradiance), gpu::writes("radiance", map.radiance)},
      shaders::BrdfConstants{.emitted = emitted ? 1.0f : 0.0f}, map.workgroups, map.workgroups);
}

}  // namespace lichtveld::lightfield
