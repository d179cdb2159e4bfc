// How near light maps come by how large the lamp is, by method.
#pragma once

#include <filesystem>

#include "sweep.hpp"

namespace lichtveld::bench {

// Rooms that one lamp of the same power lights, from the whole ceiling to a candle: each named after its lamp's
// share of the ceiling.
SweepResult compare_lamps(const gpu::Device& device, const SweepOptions& options, const ReferenceCache& cache);

// lamps.svg, .png: error against the lamp's share of the ceiling, a line a method.
void plot_lamps(const SweepResult& result, const std::filesystem::path& folder);

}  // namespace lichtveld::bench
