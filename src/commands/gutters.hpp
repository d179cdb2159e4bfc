#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::commands {

// Gives every texel beyond the charts (A = 0) of size * size light, so that a bilinear look-up at a chart's
// border finds its own there: scene::gutter_sources, and farther off the mean of the nearest neighbours that
// have a value. A stays 0.
void fill_gutters(const scene::Scene& scene, std::uint32_t size, std::span<glm::vec4> texels);

}  // namespace lichtveld::commands
