#include <spdlog/spdlog.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "bake.hpp"
#include "lichtveld/lightfield/presenter.hpp"
#include "lichtveld/reference/path_tracer.hpp"

namespace lichtveld::commands {

namespace {

// The root of the mean squared standard error over the valid texels, as a share of E's mean: what rel_rmse
// against the exact answer has to be expected.
double expected_rel_rmse(const reference::Irradiance& traced) {
  double squares = 0, sum = 0;
  for (std::size_t texel = 0; texel < traced.texels.size(); ++texel) {
    if (traced.texels[texel].a == 0) continue;
    squares += double{traced.standard_error[texel]} * traced.standard_error[texel];
    sum += (double{traced.texels[texel].r} + traced.texels[texel].g + traced.texels[texel].b) / 3;
  }
  return sum > 0 ? std::sqrt(squares * traced.texels_valid) / sum : 0;
}

}  // namespace

Baked bake_reference(const BakeOptions& options, const BakeJob& job) {
  const reference::Settings settings{.size = options.settings.size,
                                     .bounces = options.settings.bounces,
                                     .spp = options.spp,
                                     .seed = options.settings.seed};
  const auto start = std::chrono::steady_clock::now();
  auto traced = reference::trace(job.scene, job.moved(), settings, [](double share, std::chrono::seconds left) {
    spdlog::info("{:3.0f} %, {} s left", 100 * share, left.count());
  });
  const std::chrono::duration<double, std::milli> total = std::chrono::steady_clock::now() - start;

  Baked baked{.irradiance = traced.texels, .presented = {}, .report = {}};
  if (!options.png.empty()) {
    const gpu::Device device(options.device);
    baked.presented = lightfield::present(device, job.scene, options.settings.size, job.moved(), traced.texels);
    check_validation(device);
  }
  baked.report = {
      {"device", "CPU, " + std::to_string(std::thread::hardware_concurrency()) + " threads"},
      {"method", name_of(Method::reference)},
      {"size", settings.size},
      {"spp", settings.spp},
      {"seed", settings.seed},
      {"bounces_used", settings.bounces ? nlohmann::json(*settings.bounces) : nlohmann::json("auto")},
      {"standard_error", expected_rel_rmse(traced)},
      {"texels_valid", traced.texels_valid},
      {"miss_fraction",
       traced.rays > 0 ? static_cast<double>(traced.misses) / static_cast<double>(traced.rays) : 0.0},
      {"time_ms", {{"total", total.count()}, {"passes", nlohmann::json::object()}}}};
  return baked;
}

}  // namespace lichtveld::commands
