#include "passes/tone_map.hpp"

#include "shaders/tone_map.comp.h"
#include "shaders/tone_map_exposure.comp.h"
#include "shaders/tone_map_histogram.comp.h"
#include "shared.h"

namespace lichtveld::lightfield {

ToneMap::ToneMap(const gpu::Device& device)
    : histogram_(device, "lightfield/histogram", shaders::HISTOGRAM_BINS * sizeof(std::uint32_t),
                 vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst),
      exposure_(device, "lightfield/exposure", 2 * sizeof(float), vk::BufferUsageFlagBits::eStorageBuffer),
      count_(device, "tone_map", shaders::tone_map_histogram_comp),
      expose_(device, "tone_map", shaders::tone_map_exposure_comp),
      map_(device, "tone_map", shaders::tone_map_comp) {}

void ToneMap::record(gpu::Frame& frame, const LightMap& map) const {
  frame.clear("tone_map", histogram_);
  frame.compute(count_,
                {gpu::reads("radiance", map.radiance), gpu::reads("position", map.position),
                 gpu::writes("Histogram", histogram_)},
                map.workgroups, map.workgroups);
  frame.compute(expose_, {gpu::reads("Histogram", histogram_), gpu::writes("Exposure", exposure_)}, 1, 1);
  frame.compute(map_,
                {gpu::reads("radiance", map.radiance), gpu::reads("shown", map.shown),
                 gpu::reads("Exposure", exposure_), gpu::writes("presented", map.presented)},
                map.workgroups, map.workgroups);
}

}  // namespace lichtveld::lightfield
