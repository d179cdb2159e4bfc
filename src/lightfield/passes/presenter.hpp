// What players see of an irradiance that was computed on the host.
#pragma once

#include <span>

#include "core/texel_records.hpp"
#include "passes/brdf.hpp"
#include "passes/geometry_texture.hpp"
#include "passes/light_map.hpp"
#include "passes/tone_map.hpp"

namespace lichtveld::lightfield {

class Presenter {
 public:
  // The device must outlive it.
  Presenter(const gpu::Device& device, const scene::Scene& scene, const TexelRecords& records);

  // rgb: E [W m^-2], as wide as the atlas. `covered`: texels on which something lies show their nearest open
  // one (see GeometryTexture::find_shown), a value above 0 each; as many as the atlas has texels, or none.
  Shown show(const TexelView& irradiance, std::span<const float> covered = {});

 private:
  const gpu::Device& device_;
  LightMap map_;
  GeometryTexture geometry_texture_;
  Brdf brdf_;
  ToneMap tone_map_;
};

}  // namespace lichtveld::lightfield
