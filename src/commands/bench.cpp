// lichtveld bench: what light maps cost on this machine, and how near they come to the truth.
#include "lichtveld/bench/bench.hpp"

#include "bench_options.hpp"
#include "command_list.hpp"

namespace lichtveld::commands {

void add_bench(CLI::App& application) {
  auto* command = application.add_subcommand(
      "bench", "Speed against error: every way to compute a light map, timed and compared with the truth");
  const auto options = std::make_shared<BenchOptions>();
  add_bench_options(*command, *options);
  command->callback([options, command] {
    complete(*command, *options);
    const bench::Bench bench(options->bench);
    const gpu::Device device(options->device);
    bench.run(device);
    check_validation(device);
  });
}

}  // namespace lichtveld::commands
