// What bench can be asked for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lichtveld/lightfield/settings.hpp"

namespace lichtveld::bench {

struct SweepOptions {
  std::vector<std::uint32_t> sizes, psfs;
  std::vector<std::optional<std::uint32_t>> bounces;
  std::vector<lightfield::ABuffer> abuffers;
  // Empty: each A-buffer's own (own_sort), and with at most all_sorts_up_to directions all there are, for the
  // table of passes: what a direction costs does not depend on how many there are.
  std::vector<lightfield::Sort> sorts;
  // The first of these goes with everything, the others with the last A-buffer and its own sort alone: they
  // change the error, which A-buffer and sort hardly do.
  std::vector<lightfield::PsfSize> psf_sizes;
  std::vector<lightfield::Weights> weights;
  std::uint32_t repeats = 3;
  std::uint32_t truth_spp = 4096;        // paths a texel of the truth
  std::vector<std::uint32_t> path_spps;  // of path tracing as a method to compare with
};

constexpr std::uint32_t all_sorts_up_to = 96;

struct Options {
  std::vector<std::string> scenes = {"assets/cornell.glb"};
  std::string out = "build/bench";
  std::string reference_cache;             // default_reference_cache(), unless it is named
  std::uint32_t updates = 60;              // steps of the walks
  std::vector<std::uint32_t> update_psfs;  // those of the walks
  // Instead of all that, in rooms of its own: by triangles and cores, or by the lamp's size.
  bool scale = false, lamps = false;
  bool own_rooms() const { return scale || lamps; }
  SweepOptions sweep;
};

// $XDG_CACHE_HOME/lichtveld/reference, or the same below ~/.cache or, without a home, the temporary folder.
std::filesystem::path default_reference_cache();

}  // namespace lichtveld::bench
