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
  // All of these must outlive it.
  Over(const gpu::Device& device, const scene::Scene& scene, const TexelRecords& records)
      : device_(device), scene_(scene), records_(records) {}

  // A texel that is no chart's, and the radiance that it shows instead of what is near [W m^-2 sr^-1].
  struct Instead {
    std::uint32_t texel;
    glm::vec3 radiance;
  };

  // Writes `over` of the map. irradiance: E of the atlas [W m^-2].
  void put(const LightMap& map, const TexelView& irradiance, std::span<const Instead> instead = {});

 private:
  const gpu::Device& device_;
  const scene::Scene& scene_;
  const TexelRecords& records_;
  std::optional<const Seams> seams_;  // from the first map on
};

}  // namespace lichtveld::lightfield
