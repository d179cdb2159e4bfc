// gather: one bounce over kept links, E = pi * sum w L[link] / sum w (thesis, section 4.6, the order of the
// loops turned round: texels outside, directions inside), then L = Le + albedo / pi * E for the next bounce. Of
// lamps the sum is there (direct_light.hpp), so that L leaves their Le out. Reads the link table, radiance and
// direct light; writes total_irradiance and half_difference. Costs links: a load of half a word and one of a
// vector each.
#pragma once

#include <optional>

#include "links/kept_links.hpp"

namespace lichtveld::lightfield {

class Gather {
 public:
  Gather(const gpu::Device& device, const LinkTable& table);

  // No bounce yet: E is the exact light of lamps, or 0, and L = Le + albedo / pi * E.
  void start(gpu::Frame& frame, const KeptLinks& links) const;
  // Over all directions.
  void bounce(gpu::Frame& frame, const KeptLinks& links) const;
  // Over `parts` parts of the directions (of DirectionSet::parts), from `first` on and round; of the others the
  // sums of before count on, but beside what has moved, where most of the links are new.
  void part_bounce(gpu::Frame& frame, const KeptLinks& links, std::uint32_t first, std::uint32_t parts);

  // Of a start, or a bounce over all directions, that the frame has waited for.
  struct Change {
    double most;  // largest change of E, any texel and channel [W m^-2]
    double mean;  // of E
  };
  Change change(const LinkTable& table) const;

 private:
  // Of all texels, or of so many groups that groups_ lists.
  void gather(gpu::Frame& frame, const KeptLinks& links, std::uint32_t first, std::uint32_t parts,
              std::optional<std::uint32_t> listed = {}) const;
  void end(gpu::Frame& frame, const KeptLinks& links, bool counted) const;

  const gpu::Device& device_;
  gpu::ComputePipeline gather_, end_, change_;
  gpu::Buffer radiance_;  // vec4 a link: of each texel, without lamps; of a miss and of what is not known
  gpu::Buffer sums_;      // vec4 a texel, part by part
  gpu::Buffer groups_;    // uint each, host-visible
  gpu::Buffer changed_;   // vec2 a texel: link_bounce.comp
  gpu::Buffer changes_;   // vec2 a workgroup of link_change.comp, host-visible
};

}  // namespace lichtveld::lightfield
