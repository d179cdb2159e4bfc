#include <chrono>

#include "bake.hpp"
#include "files.hpp"
#include "lichtveld/gpu/transfer.hpp"
#include "lichtveld/lightfield/thesis.hpp"
#include "report.hpp"

namespace lichtveld::commands {

Baked bake_thesis(const BakeOptions& options, const BakeJob& job) {
  const gpu::Device device(options.device);
  lightfield::StageObserver observer;
  if (!options.dump.empty()) {
    observer = [&](const std::string& stage, const gpu::Image& image) {
      write_exr(std::filesystem::path(options.dump) / (stage + ".exr"), gpu::download<glm::vec4>(device, image),
                image.shape().width);
    };
  }

  const auto start = std::chrono::steady_clock::now();
  lightfield::Thesis method(device, job.scene, options.settings);
  if (options.live) {  // as a server: at rest first, then a light map after every move
    auto offsets = job.at_rest();
    method.solve(offsets);
    for (const auto& move : job.moves) {
      offsets[move.body] += move.by;
      method.solve(offsets);
    }
  }
  const auto solution = method.solve(job.moved(), observer, options.dump_psf);
  Baked baked{.irradiance = method.irradiance(), .presented = {}, .report = {}};
  const std::chrono::duration<double, std::milli> total = std::chrono::steady_clock::now() - start;

  if (!options.png.empty()) baked.presented = method.presented();
  baked.report = report(device, Method::thesis, options.settings, solution, method.times(), total.count());
  check_validation(device);
  return baked;
}

}  // namespace lichtveld::commands
