#include <chrono>
#include <type_traits>

#include "bake.hpp"
#include "lichtveld/files/output.hpp"
#include "lichtveld/gpu/transfer.hpp"
#include "lichtveld/lightfield/links.hpp"
#include "lichtveld/lightfield/thesis.hpp"
#include "report.hpp"

namespace lichtveld::commands {

namespace {

// What moves may have made of kept links, by a look at all of them; misses are counted anew with them.
nlohmann::ordered_json look_again(lightfield::Links& links, const BakeOptions& options,
                                  lightfield::Solution& solution) {
  const auto check = links.check(options.settings.psf);
  solution.misses = check.misses;
  solution.rays_unknown = check.rays_unknown;
  return {{"checked", check.links},
          {"differing", check.differing},
          {"differing_fraction", static_cast<double>(check.differing) / static_cast<double>(check.links)}};
}

// solve(light field, offsets) computes the light map that is baked.
template <typename LightField, typename Solve>
Baked bake_on(const gpu::Device& device, const BakeOptions& options, const BakeJob& job, const Solve& solve) {
  const auto start = std::chrono::steady_clock::now();
  LightField field(device, job.scene, options.settings);
  if (options.live) {  // as a server: at rest first, then a light map after every move
    auto offsets = job.at_rest();
    field.solve(offsets);
    for (const auto& move : job.moves) {
      offsets[move.body] += move.by;
      field.solve(offsets);
    }
  }
  auto solution = solve(field, job.moved());
  Baked baked{.irradiance = field.irradiance(), .presented = {}, .report = {}};
  const std::chrono::duration<double, std::milli> total = std::chrono::steady_clock::now() - start;

  if (!options.png.empty()) baked.presented = field.presented();
  const auto times = field.times();
  nlohmann::ordered_json links;
  if constexpr (std::is_same_v<LightField, lightfield::Links>)
    if (options.live) links = look_again(field, options, solution);
  baked.report = report(device, options.method, options.settings, solution, times, total.count());
  if (!links.empty()) baked.report["links"] = links;
  check_validation(device);
  return baked;
}

}  // namespace

Baked bake_links(const BakeOptions& options, const BakeJob& job) {
  const gpu::Device device(options.device);
  return bake_on<lightfield::Links>(
      device, options, job, [](lightfield::Links& links, const auto& offsets) { return links.solve(offsets); });
}

Baked bake_thesis(const BakeOptions& options, const BakeJob& job) {
  const gpu::Device device(options.device);
  lightfield::StageObserver observer;
  if (!options.dump.empty()) {
    observer = [&](const std::string& stage, const gpu::Image& image) {
      files::write_exr(std::filesystem::path(options.dump) / (stage + ".exr"),
                       gpu::download<glm::vec4>(device, image), image.shape().width);
    };
  }
  return bake_on<lightfield::Thesis>(device, options, job,
                                     [&](lightfield::Thesis& thesis, const auto& offsets) {
                                       return thesis.solve(offsets, observer, options.dump_psf);
                                     });
}

}  // namespace lichtveld::commands
