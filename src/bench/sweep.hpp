// Every way to compute a scene's light map that bench was asked for, timed and compared with the truth.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lichtveld/bench/options.hpp"
#include "lichtveld/gpu/device.hpp"
#include "reference_cache.hpp"
#include "row.hpp"

namespace lichtveld::bench {

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
  std::vector<Row> rows;
  std::vector<Truth> truths;  // none of a scene that is dark
};

void append(SweepResult& all, SweepResult&& more);

// The rows of a scene, not yet measured. Throws std::invalid_argument for settings out of their ranges.
std::vector<Row> rows_of(const std::string& scene, const SweepOptions& options);

// One light map of an A-buffer's curve: its own sort if that is among those asked for, the first values of the
// rest.
lightfield::Settings curve_settings(lightfield::ABuffer abuffer, std::uint32_t size, std::uint32_t psf,
                                    const SweepOptions& options);

bool is_dark(const scene::Scene& scene);  // nothing glows, and errors would be shares of nothing

// Measures rows. `name` is the scene's in the tables. A dark scene has no truth and no errors.
SweepResult sweep(const gpu::Device& device, const scene::Scene& scene, const std::string& name,
                  std::vector<Row> rows, const SweepOptions& options, const ReferenceCache& cache);

}  // namespace lichtveld::bench
