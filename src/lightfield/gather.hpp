// gather: one bounce over kept links, E = pi * sum w L[link] / sum w (thesis, section 4.6, the order of the
// loops turned round: texels outside, directions inside), then L = Le + albedo / pi * E, packed and in
// full, for the next bounce. Reads the link table and radiance; writes total_irradiance and half_difference.
// Costs links: a load of half a word and one or three of a word each.
#pragma once

#include <array>
#include <initializer_list>

#include "lichtveld/lightfield/directions.hpp"
#include "lichtveld/lightfield/settings.hpp"
#include "link_table.hpp"

namespace lichtveld::lightfield {

class Gather {
 public:
  // `scale`: what radiance is multiplied by to fit its packing.
  Gather(const gpu::Device& device, const LinkTable& table, const std::vector<Direction>& directions,
         float scale);

  // L = Le: no bounce yet.
  void start(gpu::Frame& frame, const LightMap& map, const LinkTable& table) const;
  // Over these halves of the directions; of the others the sums of before count on.
  void bounce(gpu::Frame& frame, const LightMap& map, const LinkTable& table, Radiance radiance,
              std::initializer_list<std::uint32_t> halves = {0, 1}) const;

  const gpu::Buffer& directions() const { return directions_; }  // vec4 a pair: xyz; w: solid angle [sr]

  // After a bounce that the frame has waited for.
  struct Change {
    double most;  // largest change of E, any texel and channel [W m^-2]
    double mean;  // of E
  };
  Change change(const LinkTable& table) const;

 private:
  void end(gpu::Frame& frame, const LightMap& map, const LinkTable& table) const;

  std::uint32_t pairs_;
  float scale_;
  gpu::ComputePipeline gather_packed_, gather_full_, end_;
  gpu::Buffer packed_, full_;        // radiance [scaled]; that after the last texel stays black
  gpu::Buffer directions_;           // vec4 a pair
  std::array<gpu::Buffer, 2> sums_;  // of each half of the directions
  gpu::Buffer changes_;              // vec2 a workgroup, host-visible
};

}  // namespace lichtveld::lightfield
