// What a light field is computed with.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace lichtveld::lightfield {

enum class ABuffer { stencil, list };
enum class Sort { bitonic, compare_swap, scan };  // as SORT_* in shaders/include/shared.h
// A direction's share: its solid angle (the thesis' correction factor), or the same for all.
enum class Weights { solid_angle, equal };
// Light straight from lamps: in closed form, with shadows by sample points; or by the directions, as all other
// light.
enum class Direct { exact, psf };
// Texels that nobody sees, inside of what stands there: they take the light of their visible neighbours, or are
// lit as if nothing of it had backs.
enum class Buried { neighbours, lit };

// The words for them, on the command line and in tables.
const std::map<std::string, ABuffer>& words_of_abuffers();
const std::map<std::string, Sort>& words_of_sorts();
const std::map<std::string, Weights>& words_of_weights();
const std::map<std::string, Direct>& words_of_directs();
const std::map<std::string, Buried>& words_of_burieds();
std::string name_of(ABuffer abuffer);
std::string name_of(Sort sort);
std::string name_of(Weights weights);

// What the A-buffer can hold: the stencil counts a pixel's layers in 8 bits.
constexpr std::uint32_t most_layers = 128;

// Of the engine `thesis`.
struct ThesisSettings {
  ABuffer abuffer = ABuffer::stencil;
  Sort sort = Sort::compare_swap;
};

// Of the engine `links`.
struct LinksSettings {
  // Bounces of the map after a move, 1.., or 0.5, 0.25 or 0.125: over that share of the directions, in turn,
  // and over all of them beside what has moved. Light straight from lamps is always of all.
  float step_bounces = 0.125f;
};

// Of the engine `rays`.
struct RaysSettings {
  // Sets of directions that neighbouring texels share out among themselves: 1, 4 (blocks of 2 x 2) or 16 (4 x
  // 4).
  std::uint32_t sets = 16;
};

// The side of a PSF's raster: so many pixels, or so many times the light map's texels.
struct PsfSize {
  double value = 1;
  bool times = true;
  bool operator==(const PsfSize&) const = default;

  // Settings::psf_size for a light map of `size` texels a side.
  std::uint32_t pixels(std::uint32_t size) const;
};

struct Settings {
  std::uint32_t size = 256;    // atlas, texels a side: 16..4096
  std::uint32_t psf = 384;     // directions: one of direction_counts()
  std::uint32_t psf_size = 0;  // PSF raster, pixels a side: 16..8192; 0: as many as the atlas has texels
  // Path segments up to the texel, 1 = direct light; empty: until converged.
  std::optional<std::uint32_t> bounces = {};
  std::uint32_t layers = 8;  // of an A-buffer: 1..128; scenes that need more get more, and say so
  Weights weights = Weights::solid_angle;
  std::uint64_t seed = 0;  // of the directions' rotations and rasters: the same seed gives the same light map
  ThesisSettings thesis = {};
  LinksSettings links = {};
  RaysSettings rays = {};
  std::uint64_t memory = 0;           // bytes that links may take; 0: most of what is free
  std::optional<Direct> direct = {};  // empty: exact, but of `thesis` as published
  Buried buried = Buried::neighbours;

  std::uint32_t raster() const { return psf_size > 0 ? psf_size : size; }  // of a PSF [pixels a side]
};

// Throws std::invalid_argument that names the setting out of its range and the range.
void check(const Settings& settings);

}  // namespace lichtveld::lightfield
