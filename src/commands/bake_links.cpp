#include <chrono>

#include "bake.hpp"
#include "lichtveld/lightfield/links.hpp"
#include "report.hpp"

namespace lichtveld::commands {

Baked bake_links(const BakeOptions& options, const BakeJob& job) {
  const gpu::Device device(options.device);
  const auto start = std::chrono::steady_clock::now();
  lightfield::Links method(device, job.scene, options.settings);
  if (options.live) {  // as a server: everything at rest first, then one move after the other
    auto offsets = job.at_rest();
    method.solve(offsets);
    for (const auto& move : job.moves) {
      offsets[move.body] += move.by;
      method.solve(offsets);
    }
  }
  const auto solution = method.solve(job.moved());
  Baked baked{.irradiance = method.irradiance(), .presented = {}, .report = {}};
  const std::chrono::duration<double, std::milli> total = std::chrono::steady_clock::now() - start;

  if (!options.png.empty()) baked.presented = method.presented();
  baked.report = report(device, Method::links, options.settings, solution, method.times(), total.count());
  check_validation(device);
  return baked;
}

}  // namespace lichtveld::commands
