#include "lichtveld/room/quality.hpp"

#include <spdlog/spdlog.h>

#include <array>

#include "lichtveld/scene/motion.hpp"

namespace lichtveld::room {

namespace {

struct Quality {
  std::uint32_t size, psf;
};

// Each step costs two to four times the one before, where the work is bound by texels.
constexpr std::array<Quality, 6> coarse_to_fine = {
    {{64, 24}, {64, 96}, {128, 96}, {128, 384}, {256, 384}, {256, 1536}}};

std::chrono::duration<double, std::milli> time_of(const lightfield::Engine& engine, const gpu::Device& device,
                                                  const scene::Scene& scene,
                                                  const lightfield::Settings& settings) {
  const auto light = engine.make(device, scene, settings);
  scene::Offsets offsets(scene.bodies.size(), glm::vec3(0));
  light->settle();
  std::chrono::duration<double, std::milli> took{};
  for (const float way : {1.0f, 2.0f}) {  // drivers compile on the first use
    if (scene.bodies.size() > 1) offsets[1].x = way * scene::step_length(scene);
    const auto start = std::chrono::steady_clock::now();
    light->place(offsets);
    light->step([](std::uint32_t) { return true; });
    took = std::chrono::steady_clock::now() - start;
  }
  return took;
}

}  // namespace

lightfield::Settings finest_within(std::chrono::milliseconds budget, const lightfield::Engine& engine,
                                   const gpu::Device& device, const scene::Scene& scene,
                                   lightfield::Settings settings, const std::function<bool()>& stopped) {
  lightfield::Settings finest = settings;
  finest.size = coarse_to_fine.front().size;
  finest.psf = coarse_to_fine.front().psf;
  for (const Quality& quality : coarse_to_fine) {
    if (stopped()) break;
    settings.size = quality.size;
    settings.psf = quality.psf;
    const auto took = time_of(engine, device, scene, settings);
    spdlog::info("--size {} --psf {}: {:.0f} ms a map", quality.size, quality.psf, took.count());
    if (took > budget) break;
    finest = settings;
  }
  return finest;
}

}  // namespace lichtveld::room
