// What `lichtveld bench` can be asked for.
#pragma once

#include <string>
#include <vector>

#include "lichtveld/bench/options.hpp"
#include "options.hpp"

namespace lichtveld::commands {

struct BenchOptions {
  bench::Options bench;
  bool quick = false;
  gpu::DeviceOptions device;
};

void add_bench_options(CLI::App& command, BenchOptions& options);

// Once the command line is read: --quick's values where no others were given, and each value of a list once.
// Throws UsageError for what cannot be.
void complete(const CLI::App& command, BenchOptions& options);

}  // namespace lichtveld::commands
