// Every way to compute a scene's light map that bench was asked for, timed and compared with the truth.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bench_row.hpp"
#include "lichtveld/gpu/device.hpp"
#include "reference_cache.hpp"

namespace lichtveld::commands {

struct SweepOptions {
  std::vector<std::uint32_t> sizes, psfs;
  std::vector<std::optional<std::uint32_t>> bounces;
  std::vector<lightfield::ABuffer> abuffers;
  // Empty: each A-buffer's own (own_sort), and with at most all_sorts_up_to directions all there are, for the
  // table of passes: what a direction costs does not depend on how many there are.
  std::vector<lightfield::Sort> sorts;
  // The first of these goes with everything, the others with the last A-buffer and its own sort alone: they
  // change the error, which A-buffer and sort hardly do.
  std::vector<PsfSize> psf_sizes;
  std::vector<lightfield::Weights> weights;
  std::uint32_t repeats = 3;
  std::uint32_t truth_spp = 4096;        // paths a texel of the truth
  std::vector<std::uint32_t> path_spps;  // of path tracing as a method to compare with
};

constexpr std::uint32_t all_sorts_up_to = 96;

// What a scene's light maps of one size and bounces are compared with.
struct Truth {
  std::string scene;
  std::uint32_t size = 0;
  std::optional<std::uint32_t> bounces;
  reference::Irradiance light;
  double noise = 0;  // its expected_rel_rmse
  std::uint32_t spp = 0;
};

struct SweepResult {
  std::vector<BenchRow> rows;
  std::vector<Truth> truths;  // none of a scene that is dark
};

// The rows of a scene, not yet measured. Throws std::invalid_argument for settings out of their ranges.
std::vector<BenchRow> rows_of(const std::string& scene, const SweepOptions& options);

// One light map of an A-buffer's curve: its own sort if that is among those asked for, the first values of the
// rest.
lightfield::Settings curve_settings(lightfield::ABuffer abuffer, std::uint32_t size, std::uint32_t psf,
                                    const SweepOptions& options);

bool is_dark(const scene::Scene& scene);  // nothing glows, and errors would be shares of nothing

// Measures them. `name` is the scene's in the tables. A dark scene has no truth and no errors.
SweepResult sweep(const gpu::Device& device, const scene::Scene& scene, const std::string& name,
                  const SweepOptions& options, const ReferenceCache& cache);

}  // namespace lichtveld::commands
