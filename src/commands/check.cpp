// lichtveld check: what a scene holds, lacks and needs, on a page.
#include "check.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdio>
#include <utility>

#include "command_list.hpp"
#include "lichtveld/files/output.hpp"
#include "lichtveld/lightfield/buried.hpp"
#include "lichtveld/lightfield/engine.hpp"
#include "lichtveld/progress/progress.hpp"
#include "lichtveld/scene/lights.hpp"
#include "lichtveld/stream/encoder.hpp"
#include "light_options.hpp"
#include "options.hpp"

namespace lichtveld::commands {

namespace {

constexpr const char* to_stdout = "-";

struct CheckOptions {
  std::string scene, json, png;
  std::uint32_t size = lightfield::Settings{}.size;
  bool no_trial = false;
  LightOptions lights;
  gpu::DeviceOptions device;
};

// Trials of larger scenes take longer than a page should.
constexpr std::size_t largest_tried = 200'000;
// No further trial is begun after that time.
constexpr std::chrono::seconds time_for_trials(4);

void check_outputs(const CheckOptions& options) {
  std::vector<files::NamedFile> files = {{"the scene", options.scene}};
  if (!options.png.empty()) {
    files::check_place(options.png, ".png");
    files.push_back({"--png", options.png});
  }
  if (!options.json.empty() && options.json != to_stdout) {
    files::check_place(options.json);
    files.push_back({"--json", options.json});
  }
  files::check_distinct(files);
}

// As `lichtveld bake` without options but --size.
Outlook outlook_of(const scene::Checked& checked, const CheckOptions& options) {
  Outlook outlook;
  if (options.no_trial) {
    outlook.why_not = "--no-trial";
  } else if (checked.facts.atlas.texels == 0) {
    outlook.why_not = "no texel lies on a chart";
  } else if (!scene::has_light(checked.scene)) {
    outlook.why_not = "nothing emits light";
  } else if (checked.facts.pieces > largest_tried) {
    outlook.why_not =
        fmt::format("of more than {} triangles a trial takes long; bake --error 2% makes it", largest_tried);
  }
  if (!outlook.why_not.empty()) return outlook;
  try {
    const gpu::Device device(options.device);
    outlook.device = device.summary().name;
    Method method;
    for (const auto& engine : lightfield::engines()) method.engines.push_back(&engine);
    lightfield::Settings settings;
    settings.size = options.size;
    const auto& engine = engine_of(method, device, checked.scene, settings);
    outlook.method = engine.name;
    const auto end = std::chrono::steady_clock::now() + time_for_trials;
    lightfield::Forecast forecast(engine, device, checked.scene, settings,
                                        {.size = settings.size, .psf = settings.psf},
                                        [&] { return std::chrono::steady_clock::now() > end; });
    outlook.expected = forecast.of({settings.size, settings.psf});
    check_validation(device);
  } catch (const gpu::NoDevice& error) {
    outlook.why_not = error.what();
  } catch (const std::runtime_error& error) {  // it does not fit into memory, say
    outlook.why_not = error.what();
  }
  return outlook;
}

void write_picture(const CheckOptions& options, const scene::AtlasFacts& atlas) {
  const Picture picture = picture_of(atlas);
  files::write_bytes(options.png, stream::encode_png(picture.rgba, picture.size));
  spdlog::info("{}: the atlas, {} pixels a texel; red is shared, white frames are charts without a texel",
               options.png, picture.size / atlas.size);
}

void run_check(const CheckOptions& options) {
  check(scene::UnwrapOptions{.size = options.size});
  check_outputs(options);
  const auto load = load_options(options.lights, {.size = options.size});
  const progress::Work work("check");
  auto checked = scene::check(options.scene, load);
  CheckedScene result{.file = options.scene,
                      .lumens_per_watt = options.lights.lumens_per_watt,
                      .facts = {},
                      .texels_buried = lightfield::BuriedTexels(checked.scene, options.size).count(),
                      .outlook = outlook_of(checked, options)};
  result.facts = std::move(checked.facts);
  if (!options.png.empty()) write_picture(options, result.facts.atlas);
  const std::string json =
      json_of(result).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  if (!options.json.empty() && options.json != to_stdout) files::write_text(options.json, json);
  std::fputs(options.json == to_stdout ? json.c_str() : page_of(result).c_str(), stdout);
}

}  // namespace

void add_check(CLI::App& application) {
  auto* command = application.add_subcommand(
      "check", "Say what a scene holds, what of it its light map does not show, and what to change");
  const auto options = std::make_shared<CheckOptions>();
  command->add_option("scene", options->scene, "The scene, .glb or .gltf")->required()->type_name("SCENE");
  command->add_option("--size", options->size, "Texels a side of the light map, 16..4096")
      ->capture_default_str();
  command->add_flag("--json{-}", options->json,
                    "One JSON object on stdout instead of the page; --json=FILE: in a file beside it");
  command
      ->add_option("--png", options->png,
                   "The atlas: charts in colours, shared texels red, a white frame where a chart has no texel")
      ->type_name("ATLAS.png");
  command->add_flag("--no-trial", options->no_trial,
                    "Leave out the error and time of a bake, which short trials on the device tell");
  add_light_source_options(*command, options->lights);
  add_device_options(*command, options->device);
  command->callback([options] { run_check(*options); });
}

}  // namespace lichtveld::commands
