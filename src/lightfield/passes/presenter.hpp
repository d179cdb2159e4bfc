// What players see of an irradiance that was computed on the host.
#pragma once

#include <span>

#include "core/texel_records.hpp"
#include "passes/brdf.hpp"
#include "passes/geometry_texture.hpp"
#include "passes/light_map.hpp"
#include "passes/over.hpp"
#include "passes/tone_map.hpp"

namespace lichtveld::lightfield {

class Presenter {
 public:
  // All of these must outlive it.
  Presenter(const gpu::Device& device, const scene::Scene& scene, const TexelRecords& records);

  // Lights give `scales` times what the file says from now on.
  void dim(const scene::Scales& scales);

  // irradiance: E of the atlas [W m^-2]. `covered`: texels on which something lies show their nearest open
  // one (see GeometryTexture::find_shown), a value above 0 each; as many as the atlas has texels, or none.
  // `instead`: what shows a light of its own (see Over).
  Shown show(std::span<const glm::vec4> irradiance, const Adaptation& adaptation,
             std::span<const float> covered = {}, std::span<const Over::Instead> instead = {});

 private:
  const gpu::Device& device_;
  const scene::Scene& scene_;
  const TexelRecords& records_;
  scene::Scales scales_;
  LightMap map_;
  GeometryTexture geometry_texture_;
  Brdf brdf_;
  ToneMap tone_map_;
  Over over_;
};

}  // namespace lichtveld::lightfield
