#include "scale.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <fstream>
#include <set>
#include <thread>

#include "lichtveld/files/output.hpp"
#include "lichtveld/lightfield/engine.hpp"
#include "lichtveld/scene/atlas.hpp"
#include "lichtveld/scene/motion.hpp"
#include "row.hpp"
#include "scale_room.hpp"
#include "scratch.hpp"

namespace lichtveld::bench {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array triangle_counts = {1'000u, 10'000u, 100'000u, 1'000'000u};
constexpr std::uint32_t steps = 12;
constexpr std::uint32_t cube = 1, ball = 2;  // bodies of the room

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// A body goes to and fro.
double time_steps(lightfield::LightField& light, const scene::Scene& scene, std::uint32_t body) {
  scene::Offsets offsets(scene.bodies.size(), glm::vec3(0));
  std::vector<double> ms;
  for (std::uint32_t step = 0; step < steps; ++step) {
    offsets[body].x = step % 2 == 0 ? scene::step_length(scene) : 0;
    const auto start = Clock::now();
    light.place(offsets);
    light.step([](std::uint32_t) { return true; });
    ms.push_back(milliseconds_since(start));
  }
  light.settle();
  return median(ms);
}

std::uint64_t resident_mib() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) >> 20;
}

ScaleRow measure(const gpu::Device& device, const std::string& file, std::uint32_t triangles,
                 std::uint32_t cores, std::uint32_t size) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, cores);
  ScaleRow row{.triangles = triangles,
               .cores = cores,
               .load_ms = 0,
               .first_ms = 0,
               .cube_ms = 0,
               .ball_ms = 0,
               .resident_mib = 0};
  auto start = Clock::now();
  const auto scene = scene::load(file);
  scene::check_atlas(scene, size);
  row.load_ms = milliseconds_since(start);
  start = Clock::now();
  const auto& rays = lightfield::engine(rays_method);
  const auto light = rays.make(device, scene, {.size = size, .psf = rays.psf});
  light->settle();
  light->shown();
  row.first_ms = milliseconds_since(start);
  row.cube_ms = time_steps(*light, scene, cube);
  row.ball_ms = time_steps(*light, scene, ball);
  row.resident_mib = resident_mib();
  return row;
}

}  // namespace

std::vector<ScaleRow> time_scale(const gpu::Device& device, std::uint32_t size) {
  const std::set<std::uint32_t> cores = {1, std::max(std::thread::hardware_concurrency(), 1u)};
  const Scratch scratch;
  const auto file = scratch.path() / "scale.glb";
  std::vector<ScaleRow> rows;
  for (const auto triangles : triangle_counts) {
    files::write_text(file, scale_room(triangles, 0.15f));
    for (const auto some : cores) {
      rows.push_back(measure(device, file.string(), triangles, some, size));
      spdlog::info("{} triangles on {} cores: first map after {:.0f} ms", triangles, some,
                   rows.back().load_ms + rows.back().first_ms);
    }
  }
  return rows;
}

std::string scale_csv(const std::vector<ScaleRow>& rows) {
  std::string csv = "triangles,cores,load_ms,first_ms,cube_step_ms,ball_step_ms,resident_mib\n";
  for (const auto& row : rows)
    csv += fmt::format("{},{},{:.1f},{:.1f},{:.2f},{:.2f},{}\n", row.triangles, row.cores, row.load_ms,
                       row.first_ms, row.cube_ms, row.ball_ms, row.resident_mib);
  return csv;
}

std::string scale_text(const std::vector<ScaleRow>& rows) {
  std::string text;
  for (const auto& row : rows)
    text += fmt::format(
        "  {:>9} triangles, {:>2} cores: load {:6.0f} ms, first map {:6.0f} ms, a step of 12 triangles "
        "{:5.1f} ms, of 5,000 {:5.1f} ms, {} MiB resident\n",
        row.triangles, row.cores, row.load_ms, row.first_ms, row.cube_ms, row.ball_ms, row.resident_mib);
  return text;
}

}  // namespace lichtveld::bench
