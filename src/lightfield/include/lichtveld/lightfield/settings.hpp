// What a light field is computed with, and what came of it.
#pragma once

#include <cstdint>
#include <optional>

namespace lichtveld::lightfield {

enum class ABuffer { stencil, list };
enum class Sort { bitonic, compare_swap, scan };  // as SORT_* in shaders/include/shared.h

// What the A-buffer can hold: the stencil counts a pixel's layers in 8 bits.
constexpr std::uint32_t most_layers = 128;

struct Settings {
  std::uint32_t size = 256;  // atlas and PSF raster, texels a side: 16..4096
  std::uint32_t psf = 384;   // directions: one of direction_counts()
  std::optional<std::uint32_t> bounces =
      {};                    // path segments up to the texel, 1 = direct light; empty: until converged
  std::uint32_t layers = 8;  // of the A-buffer: 1..128; scenes that need more get more, and say so
  ABuffer abuffer = ABuffer::stencil;
  Sort sort = Sort::compare_swap;
};

// Throws std::invalid_argument that names the setting out of its range and the range.
void check(const Settings& settings);

struct Solution {
  std::uint32_t bounces = 0;
  // What may still be missing from E, as a share of its mean: largest change in the last bounce / (1 - max
  // albedo), which is more than all later bounces add. Infinite where some albedo is 1.
  double residual = 0;
  std::uint32_t texels_valid = 0;
  std::uint32_t depth_layers_max = 0;  // most layers that any PSF pixel has
  std::uint64_t overflow_pixels = 0;   // PSF pixels with more layers than Settings::layers
  std::uint64_t rays = 0, misses = 0;  // of texels that face their direction; those that hit nothing
};

}  // namespace lichtveld::lightfield
