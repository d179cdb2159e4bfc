#include "passes/brdf.hpp"

#include "shaders/brdf.comp.h"

namespace lichtveld::lightfield {

Brdf::Brdf(const gpu::Device& device)
    : reflect_(device, "brdf", brdf_comp, {.kinds = std::vector(5, gpu::Kind::storage_image)}) {}

void Brdf::record(gpu::Frame& frame, const LightMap& map) const {
  frame.compute(reflect_,
                {gpu::reads(map.source), gpu::reads(map.albedo), gpu::reads(map.emission),
                 gpu::reads(map.total_irradiance), gpu::writes(map.radiance)},
                map.groups, map.groups);
}

}  // namespace lichtveld::lightfield
