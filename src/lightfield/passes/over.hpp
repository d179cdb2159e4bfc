// What players see over a room's light itself: seams that are closed, and charts that hold no texel.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "core/seams.hpp"
#include "passes/light_map.hpp"

namespace lichtveld::lightfield {

class Over {
 public:
  // A texel that is no chart's, and the radiance that it shows instead of what is near [W m^-2 sr^-1].
  struct Instead {
    std::uint32_t texel;
    glm::vec3 radiance;
  };

  // All of these must outlive it.
  Over(const gpu::Device& device, const scene::Scene& scene, const TexelRecords& records);

  // Of the light that is shown next. irradiance: E of the atlas [W m^-2]. `instead` has the same texels each
  // time.
  void put(const TexelView& irradiance, std::span<const Instead> instead = {});

  // For tone_map: of each atlas texel the number of its value, from 1 on, or 0.
  const gpu::Image& numbers() const { return numbers_; }
  // rgb, a: what is shown is rgb + (1 - a) L.
  const gpu::Buffer& values() const { return values_; }

 private:
  void find(std::span<const Instead> instead);

  const gpu::Device& device_;
  const scene::Scene& scene_;
  const TexelRecords& records_;
  std::optional<const Seams> seams_;  // from the first map on
  gpu::Image numbers_;
  gpu::Buffer values_;  // vec4 each, host-visible
};

}  // namespace lichtveld::lightfield
