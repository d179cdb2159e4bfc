#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace lichtveld::commands {

// Gives every texel beyond the charts (A = 0) of size * size the mean of its nearest neighbours that have a
// value, so that a bilinear look-up at a chart's border finds its light there. A stays 0.
void fill_gutters(std::span<glm::vec4> texels, std::uint32_t size);

}  // namespace lichtveld::commands
