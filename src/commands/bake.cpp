// lichtveld bake: a scene's irradiance into a file.
#include <spdlog/spdlog.h>

#include <chrono>
#include <cmath>

#include "command_list.hpp"
#include "files.hpp"
#include "lichtveld/gpu/transfer.hpp"
#include "lichtveld/lightfield/thesis.hpp"
#include "lichtveld/stream/encoder.hpp"
#include "options.hpp"
#include "report.hpp"

namespace lichtveld::commands {

namespace {

struct BakeOptions {
  std::string scene, out, png, report, dump;
  std::uint32_t dump_psf = 0;
  std::vector<std::string> moves;
  bool live = false;
  gpu::DeviceOptions device;
  lightfield::Settings settings;
};

struct NodeMove {
  std::uint32_t body;
  glm::vec3 by;  // [m]
};

NodeMove parse_move(const std::string& text, const scene::Scene& scene) {
  const auto equals = text.rfind('=');
  const auto wrong = [&] {
    return UsageError("--move " + text + ": write NODE=dx,dy,dz in metres, as in --move cube1=0.5,0,0");
  };
  if (equals == std::string::npos) throw wrong();
  const auto parts = CLI::detail::split(text.substr(equals + 1), ',');
  if (parts.size() != 3) throw wrong();
  NodeMove move{scene::find_body(scene, text.substr(0, equals)), {}};
  for (int axis = 0; axis < 3; ++axis)
    if (!CLI::detail::lexical_cast(parts[axis], move.by[axis]) || !std::isfinite(move.by[axis])) throw wrong();
  return move;
}

void bake(const BakeOptions& options) {
  lightfield::check(options.settings);
  const auto scene = scene::load(options.scene);
  scene::check_atlas(scene, options.settings.size);
  std::vector<NodeMove> moves;
  for (const auto& text : options.moves) moves.push_back(parse_move(text, scene));

  const gpu::Device device(options.device);
  lightfield::StageObserver observer;
  if (!options.dump.empty()) {
    std::filesystem::create_directories(options.dump);
    observer = [&](const std::string& stage, const gpu::Image& image) {
      write_exr(std::filesystem::path(options.dump) / (stage + ".exr"), gpu::download<glm::vec4>(device, image),
                image.shape().width);
    };
  }

  const auto start = std::chrono::steady_clock::now();
  lightfield::Thesis method(device, scene, options.settings);
  std::vector<glm::vec3> offsets(scene.bodies.size(), glm::vec3(0));
  if (options.live) method.solve(offsets);
  for (const auto& move : moves) {
    offsets[move.body] += move.by;
    if (options.live && &move != &moves.back()) method.solve(offsets);
  }
  const auto solution = method.solve(offsets, observer, options.dump_psf);
  const auto irradiance = method.irradiance();
  const std::chrono::duration<double, std::milli> total = std::chrono::steady_clock::now() - start;

  check_validation(device);
  write_exr(options.out, irradiance, options.settings.size);
  if (!options.png.empty())
    write_bytes(options.png, stream::encode_png(method.presented(), options.settings.size));
  if (!options.report.empty())
    write_text(options.report,
               report(device, options.settings, solution, method.times(), total.count()).dump(2) + "\n");
  spdlog::info("{}: {} texels, {} bounces, {:.0f} ms on {}", options.out, solution.texels_valid,
               solution.bounces, total.count(), device.summary().name);
}

}  // namespace

void add_bake(CLI::App& application) {
  auto* command = application.add_subcommand("bake", "Compute a scene's irradiance into a file");
  const auto options = std::make_shared<BakeOptions>();
  command->add_option("scene", options->scene, "The scene, .glb or .gltf")->required()->type_name("SCENE");
  command->add_option("--out", options->out, "Irradiance [W/m2]: float32 RGBA, A = 1 on valid texels")
      ->required()
      ->type_name("E.exr");
  command->add_option("--png", options->png, "What players see: tone-mapped radiance, sRGB")
      ->type_name("map.png");
  command->add_option("--report", options->report, "Device, times, memory, counts, as JSON")
      ->type_name("r.json");
  command
      ->add_option("--move", options->moves, "Shift a movable node from its rest place, metres; repeats add up")
      ->type_name("NODE=dx,dy,dz")
      ->allow_extra_args(false);
  command->add_flag("--live", options->live,
                    "First compute with all nodes at rest, then apply each move, as serve does");
  command->add_option("--dump", options->dump, "Write the output of every pass there, as EXR")
      ->type_name("DIR");
  command->add_option("--dump-psf", options->dump_psf, "The direction whose A-buffer and irradiance are dumped")
      ->capture_default_str();
  add_quality_options(*command, options->settings);
  add_bounces_option(*command, options->settings);
  add_method_options(*command, options->settings);
  add_device_options(*command, options->device);
  command->callback([options] { bake(*options); });
}

}  // namespace lichtveld::commands
