// What `lichtveld bench` can be asked for.
#pragma once

#include <string>
#include <vector>

#include "options.hpp"
#include "sweep.hpp"

namespace lichtveld::commands {

struct BenchOptions {
  std::vector<std::string> scenes = {"assets/cornell.glb"};
  std::string out = "build/bench";
  std::string reference_cache;
  bool quick = false;
  std::uint32_t updates = 60;
  std::vector<std::uint32_t> update_psfs;  // those of the walks
  SweepOptions sweep;
  gpu::DeviceOptions device;
};

void add_bench_options(CLI::App& command, BenchOptions& options);

// Once the command line is read: --quick's values where no others were given, and each value of a list once.
// Throws UsageError for what cannot be.
void complete(const CLI::App& command, BenchOptions& options);

}  // namespace lichtveld::commands
