// direct_light: the light that comes straight from lamps, kept by changed links alone: for each texel and half
// of the directions the sum of w Le over the lamps that it sees. A link that is replaced takes its share off
// and adds the new one's (relink.glsl). The sums are whole numbers: whatever comes and goes, they are those of
// the links as they are.
#pragma once

#include "lichtveld/gpu/frame.hpp"
#include "links/link_table.hpp"
#include "passes/light_map.hpp"

namespace lichtveld::lightfield {

class DirectLight {
 public:
  // Of a table that links nothing yet.
  DirectLight(const gpu::Device& device, const LinkTable& table);

  // Sums it up afresh. `directions`: vec4 a pair: xyz; w: solid angle [sr]. Costs links: a load of half a word
  // each.
  void sum(gpu::Frame& frame, const LightMap& map, const LinkTable& table, const gpu::Buffer& directions) const;

  float scale() const { return scale_; }               // of the sums: w Le [W m^-2] times this
  const gpu::Buffer& lamps() const { return lamps_; }  // float: Le of each lamp, three channels, times scale
  const gpu::Buffer& sums() const { return sums_; }    // uint: of each texel and half, three channels

 private:
  gpu::ComputePipeline sum_;
  float scale_;
  gpu::Buffer lamps_, sums_;
};

}  // namespace lichtveld::lightfield
