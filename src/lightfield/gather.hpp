// gather: one bounce over kept links, E = pi * sum w L[link] / sum w (thesis, section 4.6, the order of the
// loops turned round: texels outside, directions inside), then L = Le + albedo / pi * E, packed and in
// full, for the next bounce. Of lamps the sum is there (direct_light.hpp), so that L leaves their Le out. Reads
// the link table, radiance and direct light; writes total_irradiance and half_difference. Costs links: a load
// of half a word and one or three of a word each.
#pragma once

#include "kept_links.hpp"
#include "lichtveld/lightfield/settings.hpp"

namespace lichtveld::lightfield {

class Gather {
 public:
  // `scale`: what radiance is multiplied by to fit its packing.
  Gather(const gpu::Device& device, const LinkTable& table, float scale);

  // E = 0, L = Le: no bounce yet.
  void start(gpu::Frame& frame, const KeptLinks& links) const;
  // Over `parts` parts of the directions (of shaders::PARTS), from `first` on and round; of the others the sums
  // of before count on.
  void bounce(gpu::Frame& frame, const KeptLinks& links, Radiance radiance, std::uint32_t first = 0,
              std::uint32_t parts = shaders::PARTS) const;

  // After a bounce that the frame has waited for.
  struct Change {
    double most;  // largest change of E, any texel and channel [W m^-2]
    double mean;  // of E
  };
  Change change(const LinkTable& table) const;

 private:
  void gather(gpu::Frame& frame, const KeptLinks& links, Radiance radiance, std::uint32_t part) const;
  void end(gpu::Frame& frame, const KeptLinks& links) const;

  float scale_;
  gpu::ComputePipeline gather_packed_, gather_full_, end_;
  gpu::Buffer packed_, full_;  // radiance without lamps [scaled]; that after the last texel stays black
  gpu::Buffer sums_;           // vec4 a texel, part by part
  gpu::Buffer changes_;        // vec2 a workgroup, host-visible
};

}  // namespace lichtveld::lightfield
