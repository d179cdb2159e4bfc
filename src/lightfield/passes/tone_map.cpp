#include "passes/tone_map.hpp"

#include "shaders/tone_map.comp.h"
#include "shaders/tone_map_exposure.comp.h"
#include "shaders/tone_map_histogram.comp.h"
#include "shared.h"

namespace lichtveld::lightfield {

using gpu::Kind;

ToneMap::ToneMap(const gpu::Device& device)
    : histogram_(device, "lightfield/histogram", shaders::HISTOGRAM_BINS * sizeof(std::uint32_t),
                 vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst),
      exposure_(device, "lightfield/exposure", 2 * sizeof(float), vk::BufferUsageFlagBits::eStorageBuffer),
      count_(device, "tone_map", tone_map_histogram_comp,
             {.kinds = {Kind::storage_image, Kind::storage_image, Kind::storage_buffer}}),
      expose_(device, "tone_map", tone_map_exposure_comp,
              {.kinds = {Kind::storage_buffer, Kind::storage_buffer}}),
      map_(device, "tone_map", tone_map_comp,
           {.kinds = {Kind::storage_image, Kind::storage_image, Kind::storage_buffer, Kind::storage_image}}) {}

void ToneMap::record(gpu::Frame& frame, const LightMap& map) const {
  frame.clear("tone_map", histogram_);
  frame.compute(count_, {gpu::reads(map.radiance), gpu::reads(map.position), gpu::writes(histogram_)},
                map.groups, map.groups);
  frame.compute(expose_, {gpu::reads(histogram_), gpu::writes(exposure_)}, 1, 1);
  frame.compute(
      map_,
      {gpu::reads(map.radiance), gpu::reads(map.shown), gpu::reads(exposure_), gpu::writes(map.presented)},
      map.groups, map.groups);
}

}  // namespace lichtveld::lightfield
