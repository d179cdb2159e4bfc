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
  // All of these must outlive it.
  Presenter(const gpu::Device& device, const scene::Scene& scene, const TexelRecords& records);

  // Lights give `scales` times what the file says from now on.
  void dim(const scene::Scales& scales);

  // rgb: E [W m^-2], as wide as the atlas. `covered`: texels on which something lies show their nearest open
  // one (see GeometryTexture::find_shown), a value above 0 each; as many as the atlas has texels, or none.
  Shown show(const TexelView& irradiance, const Adaptation& adaptation, std::span<const float> covered = {});

 private:
  const gpu::Device& device_;
  const scene::Scene& scene_;
  const TexelRecords& records_;
  scene::Scales scales_;
  LightMap map_;
  GeometryTexture geometry_texture_;
  Brdf brdf_;
  ToneMap tone_map_;
};

}  // namespace lichtveld::lightfield
