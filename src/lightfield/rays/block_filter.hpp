// Neighbouring texels look along different sets of directions; what each finds is averaged over the block of
// all sets. The average does not reach across a crease, under a body or beyond what lies near: by at most half
// the harmonic mean of the distances that a texel sees, which is how far its light varies little (Ward and
// Heckbert 1992, "Irradiance Gradients"). Where a chart's rim makes it lopsided, a plane is fitted instead.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "rays/ray_links.hpp"
#include "rays/rows.hpp"

namespace lichtveld::lightfield {

class BlockFilter {
 public:
  static constexpr std::uint64_t bytes_a_row = 204;  // most_taps of a row and a weight each, and their number

  // All of these must outlive it. `side`: texels a side of a block; 1 averages nothing.
  BlockFilter(const Rows& rows, const RayLinks& links, std::uint32_t side);

  // After the links of these rows have changed.
  void renew(std::span<const std::uint32_t> rows);

  // Of what each row has.
  void average(std::span<const glm::vec4> values, std::span<glm::vec4> averages) const;

 private:
  static constexpr std::uint32_t most_taps = 25;
  struct Taps {
    std::uint32_t count = 0;
    std::uint32_t row[most_taps];
    float weight[most_taps];
  };

  void find(std::uint32_t row);

  const Rows& rows_;
  const RayLinks& links_;
  int radius_;
  std::vector<float> reach_;  // of each row [m]; 0 where something lies on it
  std::vector<Taps> taps_;
};

}  // namespace lichtveld::lightfield
