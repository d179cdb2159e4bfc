#include "quality.hpp"

#include <spdlog/spdlog.h>

#include <array>

#include "lichtveld/lightfield/thesis.hpp"

namespace lichtveld::commands {

namespace {

struct Quality {
  std::uint32_t size, psf;
};

// Each step costs two to four times the one before, where the work is bound by texels.
constexpr std::array<Quality, 6> coarse_to_fine = {
    {{64, 24}, {64, 96}, {128, 96}, {128, 384}, {256, 384}, {256, 1536}}};

std::chrono::duration<double, std::milli> time_of(const gpu::Device& device, const scene::Scene& scene,
                                                  const lightfield::Settings& settings) {
  lightfield::Thesis method(device, scene, settings);
  const std::vector<glm::vec3> at_rest(scene.bodies.size(), glm::vec3(0));
  method.solve(at_rest);  // drivers compile on the first use
  const auto start = std::chrono::steady_clock::now();
  method.solve(at_rest);
  return std::chrono::steady_clock::now() - start;
}

}  // namespace

lightfield::Settings finest_within(std::chrono::milliseconds budget, const gpu::Device& device,
                                   const scene::Scene& scene, lightfield::Settings settings,
                                   const std::function<bool()>& stopped) {
  lightfield::Settings finest = settings;
  finest.size = coarse_to_fine.front().size;
  finest.psf = coarse_to_fine.front().psf;
  for (const Quality& quality : coarse_to_fine) {
    if (stopped()) break;
    settings.size = quality.size;
    settings.psf = quality.psf;
    const auto took = time_of(device, scene, settings);
    spdlog::info("--size {} --psf {}: {:.0f} ms a map", quality.size, quality.psf, took.count());
    if (took > budget) break;
    finest = settings;
  }
  return finest;
}

}  // namespace lichtveld::commands
