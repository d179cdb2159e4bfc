// lichtveld bench: what each pass costs on this machine.
#include <spdlog/spdlog.h>

#include <cstdio>

#include "command_list.hpp"
#include "files.hpp"
#include "lichtveld/lightfield/thesis.hpp"
#include "options.hpp"
#include "pass_table.hpp"
#include "plot.hpp"

namespace lichtveld::commands {

namespace {

namespace fs = std::filesystem;
using lightfield::ABuffer;
using lightfield::Sort;

struct BenchOptions {
  std::vector<std::string> scenes;
  std::string out = "build/bench";
  std::vector<std::uint32_t> sizes = {128, 256}, psfs = {96, 384};
  std::uint32_t bounces = 2, repeats = 3;
  gpu::DeviceOptions device;
};

void run_once(const gpu::Device& device, const scene::Scene& scene, PassRow& row) {
  lightfield::Thesis method(device, scene, row.settings);
  const std::vector<glm::vec3> at_rest(scene.bodies.size(), glm::vec3(0));
  const auto start = std::chrono::steady_clock::now();
  method.solve(at_rest);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  row.runs.push_back(method.times());
  row.total_ms.push_back(took.count());
}

std::vector<PassRow> rows_for(const std::string& scene, const BenchOptions& options) {
  std::vector<PassRow> rows;
  for (const auto abuffer : {ABuffer::stencil, ABuffer::list})
    for (const auto sort : {Sort::bitonic, Sort::compare_swap, Sort::scan})
      for (const auto size : options.sizes)
        for (const auto psf : options.psfs)
          rows.push_back(
              {fs::path(scene).stem().string(),
               {.size = size, .psf = psf, .bounces = options.bounces, .abuffer = abuffer, .sort = sort},
               {},
               {}});
  return rows;
}

void bench(const BenchOptions& options) {
  if (options.repeats < 1) throw UsageError("--repeats: at least 1");
  make_folder(options.out);
  const gpu::Device device(options.device);
  std::vector<PassRow> rows;
  for (const auto& file : options.scenes) {
    const auto scene = scene::load(file);
    auto of_scene = rows_for(file, options);
    for (const auto& row : of_scene) lightfield::check(row.settings);
    for (const auto size : options.sizes) scene::check_atlas(scene, size);
    // Whole rounds, so that a disturbance of the machine does not fall on one row alone.
    for (std::uint32_t repeat = 0; repeat < options.repeats; ++repeat)
      for (auto& row : of_scene) {
        run_once(device, scene, row);
        spdlog::info("{} {} {} size {} psf {}: {:.0f} ms", row.scene, name_of(row.settings.abuffer),
                     name_of(row.settings.sort), row.settings.size, row.settings.psf, row.total_ms.back());
      }
    rows.insert(rows.end(), of_scene.begin(), of_scene.end());
  }
  write_text(fs::path(options.out) / "passes.csv", pass_csv(rows));
  std::printf(
      "%s, medians of %u runs, %u bounces, ms of all calls of a pass in one solve\n\n%s\nThe thesis' findings "
      "here:\n%s",
      device.summary().name.c_str(), options.repeats, options.bounces, pass_text(rows).c_str(),
      findings(rows).c_str());
  std::fflush(stdout);
  plot_passes(rows, options.out);
  check_validation(device);
}

}  // namespace

void add_bench(CLI::App& application) {
  auto* command =
      application.add_subcommand("bench", "Time every pass, by A-buffer, sort, size and directions");
  const auto options = std::make_shared<BenchOptions>();
  options->scenes = {"assets/cornell.glb"};
  command->add_option("--scene", options->scenes, "Scenes, .glb or .gltf")
      ->capture_default_str()
      ->allow_extra_args(false);
  command->add_option("--out", options->out, "The folder for passes.csv, passes.svg, passes.png")
      ->capture_default_str();
  command->add_option("--sizes", options->sizes, "Texels a side")->delimiter(',')->capture_default_str();
  command->add_option("--psfs", options->psfs, "Directions")->delimiter(',')->capture_default_str();
  command->add_option("--bounces", options->bounces, "Bounces of each solve")->capture_default_str();
  command->add_option("--repeats", options->repeats, "Runs of each row; the medians are reported")
      ->capture_default_str();
  add_device_options(*command, options->device);
  command->callback([options] { bench(*options); });
}

}  // namespace lichtveld::commands
