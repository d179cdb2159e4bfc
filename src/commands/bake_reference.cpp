#include <spdlog/spdlog.h>

#include <chrono>
#include <thread>

#include "bake.hpp"
#include "lichtveld/lightfield/presenter.hpp"
#include "lichtveld/reference/error.hpp"

namespace lichtveld::commands {

Baked bake_reference(const BakeOptions& options, const BakeJob& job) {
  const reference::Settings settings{.size = options.settings.size,
                                     .bounces = options.settings.bounces,
                                     .spp = options.spp,
                                     .seed = options.settings.seed};
  const auto start = std::chrono::steady_clock::now();
  auto traced = reference::trace(job.scene, job.moved(), settings);
  const std::chrono::duration<double, std::milli> total = std::chrono::steady_clock::now() - start;

  Baked baked{.size = settings.size, .irradiance = traced.texels, .shown = {}, .apart = {}, .report = {}};
  if (!options.png.empty()) {
    const gpu::Device device(options.device);
    baked.shown = lightfield::present(device, job.scene, {traced.texels, options.settings.size});
    check_validation(device);
  }
  baked.report = {
      {"device", "CPU, " + std::to_string(std::thread::hardware_concurrency()) + " threads"},
      {"method", reference_method},
      {"size", settings.size},
      {"spp", settings.spp},
      {"seed", settings.seed},
      {"bounces_used", settings.bounces ? nlohmann::json(*settings.bounces) : nlohmann::json("auto")},
      {"standard_error", reference::expected_rel_rmse(traced)},
      {"texels_valid", traced.texels_valid},
      {"miss_fraction",
       traced.rays > 0 ? static_cast<double>(traced.misses) / static_cast<double>(traced.rays) : 0.0},
      {"time_ms",
       {{"total", total.count()},
        {"passes", nlohmann::json::object()},
        {"host", {{"path_tracing", {{"calls", 1}, {"ms", total.count()}}}}}}}};
  return baked;
}

}  // namespace lichtveld::commands
