// What a light field is computed with, and what came of it.
#pragma once

#include <cstdint>
#include <optional>

namespace lichtveld::lightfield {

enum class ABuffer { stencil, list };
enum class Sort { bitonic, compare_swap, scan };  // as SORT_* in shaders/include/shared.h
// A direction's share: its solid angle (the thesis' correction factor), or the same for all.
enum class Weights { solid_angle, equal };

// What the A-buffer can hold: the stencil counts a pixel's layers in 8 bits.
constexpr std::uint32_t most_layers = 128;

struct Settings {
  std::uint32_t size = 256;    // atlas, texels a side: 16..4096
  std::uint32_t psf = 384;     // directions: one of direction_counts()
  std::uint32_t psf_size = 0;  // PSF raster, pixels a side: 16..8192; 0: as many as the atlas has texels
  std::optional<std::uint32_t> bounces =
      {};                    // path segments up to the texel, 1 = direct light; empty: until converged
  std::uint32_t layers = 8;  // of the A-buffer: 1..128; scenes that need more get more, and say so
  ABuffer abuffer = ABuffer::stencil;
  Sort sort = Sort::compare_swap;
  Weights weights = Weights::solid_angle;
  // links: bounces of the map after a move, 1.., or 0.5, 0.25 or 0.125: over that share of the directions, in
  // turn, and over all of them beside what has moved. Light straight from lamps is always of all.
  float step_bounces = 0.125f;
  std::uint64_t seed = 0;  // of the directions' rotations and rasters: the same seed gives the same light map

  std::uint32_t raster() const { return psf_size > 0 ? psf_size : size; }  // of a PSF [pixels a side]
};

// Throws std::invalid_argument that names the setting out of its range and the range.
void check(const Settings& settings);

struct Solution {
  std::uint32_t bounces = 0;  // one over a part of the directions counts too
  // What may still be missing from E, as a share of its mean: largest change in the last bounce / (1 - max
  // albedo), which is more than all later bounces add. Infinite where some albedo is 1.
  double residual = 0;
  bool settled = true;  // nothing that more bounces would change, as far as asked for
  // What rel_rmse against the exact answer has to be expected of this many directions and pixels: from what the
  // two halves of the directions say apart. It sees what is random about them, not what they have in common.
  double error_estimate = 0;
  std::uint32_t texels_valid = 0;
  std::uint32_t depth_layers_max = 0;  // most layers that any PSF pixel has
  std::uint64_t overflow_pixels = 0;   // PSF pixels with more layers than Settings::layers
  std::uint64_t rays = 0, misses = 0;  // of texels that face their direction; those that hit nothing
  std::uint64_t rays_unknown = 0;      // those left out: no pixel near them lies on their side of all walls
};

}  // namespace lichtveld::lightfield
