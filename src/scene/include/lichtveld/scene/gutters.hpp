// What filtering reads beside a chart.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "lichtveld/scene/atlas.hpp"

namespace lichtveld::scene {

constexpr std::uint32_t no_texel = std::numeric_limits<std::uint32_t>::max();

// For each texel of an atlas of size * size, of which `valid` are valid_texels, whose light belongs there:
// a valid one's its own; one that a bilinear look-up on some chart reads, that of the texel which is nearest in
// space to the chart's nearest place, though another chart's may lie beside it in the atlas; no_texel
// elsewhere, and where none is near.
std::vector<std::uint32_t> gutter_sources(const Scene& scene, std::uint32_t size,
                                          std::span<const AtlasTexel> valid);

}  // namespace lichtveld::scene
