#include "passes/tone_map.hpp"

#include <array>

#include "shaders/tone_map.comp.h"
#include "shaders/tone_map_exposure.comp.h"
#include "shaders/tone_map_histogram.comp.h"
#include "shared.h"

namespace lichtveld::lightfield {

ToneMap::ToneMap(const gpu::Device& device)
    : device_(device),
      histogram_(device, "lightfield/histogram", shaders::HISTOGRAM_BINS * sizeof(std::uint32_t),
                 vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst),
      exposure_(device, "lightfield/exposure", sizeof(shaders::Exposure),
                vk::BufferUsageFlagBits::eStorageBuffer, gpu::Memory::host),
      count_(device, "tone_map", shaders::tone_map_histogram_comp),
      expose_(device, "tone_map", shaders::tone_map_exposure_comp),
      map_(device, "tone_map", shaders::tone_map_comp) {
  exposure_.as<shaders::Exposure>().front() = {};
}

void ToneMap::record(gpu::Frame& frame, const LightMap& map, const Over& over,
                     const Adaptation& adaptation) const {
  frame.clear("tone_map", histogram_);
  frame.compute(count_,
                {gpu::reads("radiance", map.radiance), gpu::reads("position", map.position),
                 gpu::writes("Histogram", histogram_)},
                map.workgroups, map.workgroups);
  frame.compute(expose_, {gpu::reads("Histogram", histogram_), gpu::writes("Exposures", exposure_)},
                shaders::ExposureConstants{.fixed_average = adaptation.fixed.value_or(0),
                                           .brighter = adaptation.brighter,
                                           .darker = adaptation.darker},
                1, 1);
  frame.compute(map_,
                {gpu::reads("radiance", map.radiance), gpu::reads("shown", map.shown),
                 gpu::reads("over", over.numbers()), gpu::reads("Overs", over.values()),
                 gpu::reads("Exposures", exposure_), gpu::writes("presented", map.presented)},
                map.workgroups, map.workgroups);
  frame.to_host(exposure_);
}

Shown ToneMap::shown(const LightMap& map) const {
  const auto pixels = gpu::download<std::array<std::uint8_t, 4>>(device_, map.presented);
  const auto& exposure = exposure_.as<shaders::Exposure>().front();
  return {.format = Shown::Format::srgb8,
          .size = map.size,
          .bytes = {pixels.front().data(), pixels.front().data() + 4 * pixels.size()},
          .average = exposure.average,
          .white = exposure.white,
          .adapted = exposure.adapted != 0};
}

glm::vec3 displayed(const glm::vec3& radiance, const Shown& shown) {
  const float light = glm::dot(radiance, glm::vec3(0.2126f, 0.7152f, 0.0722f));
  if (!(light > 0)) return glm::vec3(0);
  const float scaled = light * shaders::KEY / shown.average, white = shown.white * shaders::KEY / shown.average;
  const glm::vec3 linear =
      glm::clamp(radiance * (scaled * (1 + scaled / (white * white)) / (1 + scaled) / light), 0.0f, 1.0f);
  return glm::mix(12.92f * linear, 1.055f * glm::pow(linear, glm::vec3(1 / 2.4f)) - 0.055f,
                  glm::greaterThan(linear, glm::vec3(0.0031308f)));
}

}  // namespace lichtveld::lightfield
