#include "report.hpp"

namespace lichtveld::commands {

nlohmann::ordered_json report(const gpu::Device& device, const std::string& method,
                              const lightfield::Settings& settings, const lightfield::Solution& solution,
                              const gpu::Times& times, double total_ms) {
  auto passes = nlohmann::ordered_json::object(), host = passes, memory = passes;
  for (const auto& [name, time] : times.passes) passes[name] = {{"calls", time.calls}, {"gpu_ms", time.gpu_ms}};
  for (const auto& [name, time] : times.host) host[name] = {{"calls", time.calls}, {"ms", time.ms}};
  std::uint64_t total_bytes = 0;
  for (const auto& [name, bytes] : device.ledger()->bytes_by_name()) {
    memory[name] = bytes;
    total_bytes += bytes;
  }
  memory["total"] = total_bytes;
  const bool thesis = method == "thesis";  // others have one way to find layers
  return {{"device", device.summary().name},
          {"driver", device.summary().driver},
          {"method", method},
          {"abuffer", name_of(thesis ? settings.thesis.abuffer : lightfield::ABuffer::list)},
          {"sort", name_of(thesis ? settings.thesis.sort : lightfield::Sort::scan)},
          {"size", settings.size},
          {"psf", settings.psf},
          {"psf_size", settings.raster()},
          {"weights", name_of(settings.weights)},
          {"seed", settings.seed},
          {"layers", settings.layers},
          {"bounces_used", solution.bounces},
          {"residual", solution.residual},
          {"error_estimate", solution.error_estimate},
          {"texels_valid", solution.texels_valid},
          {"depth_layers_max", solution.depth_layers_max},
          {"overflow_pixels", solution.overflow_pixels},
          {"miss_fraction",
           solution.rays > 0 ? static_cast<double>(solution.misses) / static_cast<double>(solution.rays) : 0.0},
          {"unknown_fraction",
           solution.rays > 0 ? static_cast<double>(solution.rays_unknown) / static_cast<double>(solution.rays)
                             : 0.0},
          {"time_ms", {{"total", total_ms}, {"passes", passes}, {"host", host}}},
          {"memory_bytes", memory}};
}

}  // namespace lichtveld::commands
