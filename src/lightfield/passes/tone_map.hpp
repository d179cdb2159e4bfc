// tone_map: radiance to what a browser shows: exposure from a log-luminance histogram over the valid texels,
// which adapts from map to map, Reinhard's operator on luminance, sRGB. Thesis, section 4.7; Reinhard et al.
// 2002. Reads radiance, position, shown and what is over them; writes presented. Costs texels, once a solve.
#pragma once

#include "lichtveld/lightfield/shown.hpp"
#include "passes/light_map.hpp"
#include "passes/over.hpp"

namespace lichtveld::lightfield {

class ToneMap {
 public:
  explicit ToneMap(const gpu::Device& device);
  // The exposure follows from that of the last record().
  void record(gpu::Frame& frame, const LightMap& map, const Over& over, const Adaptation& adaptation) const;
  // Of the last record(), once its frame is done.
  Shown shown(const LightMap& map) const;

 private:
  const gpu::Device& device_;
  gpu::Buffer histogram_;
  gpu::Buffer exposure_;  // shaders::Exposure, host-visible
  gpu::ComputePipeline count_, expose_, map_;
};

}  // namespace lichtveld::lightfield
