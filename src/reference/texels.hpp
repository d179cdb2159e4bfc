// Which place of which triangle each texel of the atlas is.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry.hpp"

namespace lichtveld::reference {

struct Texel {
  std::uint32_t index;  // row * size + column
  Hit hit;
};

// The valid texels of an atlas of `size` texels a side, by index: those whose centre lies on a chart.
std::vector<Texel> valid_texels(const scene::Scene& scene, std::uint32_t size);

}  // namespace lichtveld::reference
