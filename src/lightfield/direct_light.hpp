// The light that comes straight from lamps, kept by changed links alone: for each texel and half of the
// directions the sum of w Le over the lamps that it sees. A link that is replaced takes its share off and adds
// the new one's (relink.glsl). The sums are whole numbers: whatever comes and goes, they are those of the links
// as they are.
#pragma once

#include "link_table.hpp"

namespace lichtveld::lightfield {

struct DirectLight {
  // Of a table that links nothing yet.
  DirectLight(const gpu::Device& device, const LinkTable& table);

  float scale;        // of the sums: w Le [W m^-2] times this
  gpu::Buffer lamps;  // float: Le of each lamp, three channels, times scale
  gpu::Buffer sums;   // uint: of each texel and half, three channels
};

}  // namespace lichtveld::lightfield
