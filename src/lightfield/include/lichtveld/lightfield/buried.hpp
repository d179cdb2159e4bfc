// Texels that nobody sees, since what stands still stands around them: of a floor those in a wall that goes
// through it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

class BuriedTexels {
 public:
  // Looks for them in an atlas of size * size texels.
  BuriedTexels(const scene::Scene& scene, std::uint32_t size);

  std::uint32_t count() const { return count_; }

  // Those at most two texels from a visible one of their chart get the mean of those around them, so that
  // filtering draws no dark or bright line along the foot of what stands there. Row 0 on top, as many as the
  // atlas has texels.
  void take_light_of_neighbours(std::span<glm::vec4> irradiance) const;

 private:
  struct Taking {
    std::uint32_t texel, end;  // what it takes from ends there in from_
  };
  std::uint32_t count_ = 0;
  std::vector<Taking> takings_;  // nearer ones first
  std::vector<std::uint32_t> from_;
};

}  // namespace lichtveld::lightfield
