#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::commands {

// Gives every texel beyond the charts (A = 0) of size * size light, so that a bilinear look-up at a chart's
// border finds its own there: scene::gutter_sources, and farther off the mean of the nearest neighbours that
// have a value. A stays 0.
class Gutters {
 public:
  Gutters(const scene::Scene& scene, std::uint32_t size);

  void fill(std::span<glm::vec4> texels) const;  // of as many lights as there are

 private:
  std::uint32_t size_;
  std::vector<std::uint32_t> source_;
};

}  // namespace lichtveld::commands
