// lichtveld bake: a scene's irradiance into a file.
#include "bake.hpp"

#include <spdlog/spdlog.h>

#include <cmath>
#include <utility>

#include "command_list.hpp"
#include "gutters.hpp"
#include "lichtveld/files/output.hpp"
#include "lichtveld/lightfield/buried.hpp"
#include "lichtveld/progress/progress.hpp"
#include "lichtveld/scene/atlas.hpp"
#include "lichtveld/scene/lights.hpp"
#include "lichtveld/stream/encoder.hpp"
#include "lit_file.hpp"

namespace lichtveld::commands {

namespace {

BakeJob::NodeMove parse_move(const std::string& text, const scene::Scene& scene) {
  const auto equals = text.rfind('=');
  const auto wrong = [&] {
    return UsageError("--move " + text + ": write NODE=dx,dy,dz in metres, as in --move cube1=0.5,0,0");
  };
  if (equals == std::string::npos) throw wrong();
  const auto parts = CLI::detail::split(text.substr(equals + 1), ',');
  if (parts.size() != 3) throw wrong();
  BakeJob::NodeMove move{scene::find_body(scene, text.substr(0, equals)), {}};
  for (int axis = 0; axis < 3; ++axis)
    if (!CLI::detail::lexical_cast(parts[axis], move.by[axis]) || !std::isfinite(move.by[axis])) throw wrong();
  return move;
}

// Whether --dump may write there: bake_light_field.cpp names its files by stages, as in brdf.radiance.exr.
bool is_of_a_pass(const std::filesystem::path& file, const std::filesystem::path& dump) {
  const auto target = files::target_of(file);
  return target.parent_path() == files::target_of(dump) && target.extension() == ".exr" &&
         target.stem().has_extension();
}

std::vector<files::NamedFile> outputs_of(const BakeOptions& options) {
  std::vector<files::NamedFile> files;
  for (const auto& [name, file] : {std::pair{"--out", options.out},
                                   {"--gltf", options.gltf},
                                   {"--png", options.png},
                                   {"--report", options.report},
                                   {"--capture", options.capture.file}})
    if (!file.empty()) files.push_back({name, file});
  return files;
}

// Programs that read the one look for the other beside it, and find things where the file has them.
void check_gltf(const BakeOptions& options) {
  files::check_place(options.gltf, ".glb");
  const auto folder = [](const std::filesystem::path& file) {
    return files::target_of(file.has_parent_path() ? file.parent_path() : ".");
  };
  if (folder(options.gltf) != folder(options.out))
    throw UsageError("--gltf " + options.gltf + " and --out " + options.out +
                     " are in two folders; give them one, as the scene names its light map beside it");
  if (!options.moves.empty())
    throw UsageError(
        "--gltf has all nodes where the scene has them, and --move would light another; leave one out");
}

// All of them before long work, and so that none is written over another or over the scene.
void check_outputs(const BakeOptions& options) {
  files::check_place(options.out, ".exr");
  if (!options.gltf.empty()) check_gltf(options);
  if (!options.png.empty()) files::check_place(options.png, ".png");
  if (!options.report.empty()) files::check_place(options.report);
  check(options.capture);
  auto files = outputs_of(options);
  files.insert(files.begin(), {"the scene", options.scene});
  files::check_distinct(files);
  if (!options.lights_apart.empty()) files::make_folder(options.lights_apart);
  if (options.dump.empty()) return;
  for (const auto& [name, file] : files)
    if (is_of_a_pass(file, options.dump))
      throw UsageError(name + " " + file.string() +
                       ": files PASS.OUTPUT.exr of the folder --dump are the passes'; name it otherwise");
  files::make_folder(options.dump);
}

// An atlas that had to be larger than is said is baked as large, unless a size is asked for.
void suit_atlas(BakeOptions& options, const scene::Scene& scene) {
  const auto size = scene.unwrapped_size;
  if (size <= options.settings.size) return;
  if (options.fixed.size) {
    spdlog::warn("{}: its charts find no room in {} x {} texels, and share some at that size; try --size {}",
                 options.scene, options.settings.size, options.settings.size, size);
    return;
  }
  options.settings.size = size;
  options.fixed.size = size;
}

// The scene for other programs; nothing may be written over its sky.
LitFile lit_scene(const BakeOptions& options, const scene::UnwrapOptions& unwrap, scene::Scene& scene) {
  if (options.gltf.empty()) return {};
  auto lit = lit_file(options.scene, unwrap, scene, options.gltf);
  for (const auto& beside : lit.beside)
    for (const auto& output : outputs_of(options))
      files::check_distinct({{"the scene's sky", beside.to}, output});
  return lit;
}

void bake(BakeOptions options) {
  lightfield::check(options.settings);
  check_outputs(options);
  if (options.dump_psf >= options.settings.psf)
    throw UsageError("--dump-psf " + std::to_string(options.dump_psf) + ": the directions are numbered 0.." +
                     std::to_string(options.settings.psf - 1));
  const progress::Work work("bake");
  const scene::UnwrapOptions unwrap{
      .size = options.settings.size,
      .keep_uv = options.keep_uv,
      .light_map = options.gltf.empty() ? "" : uri_of(std::filesystem::path(options.out).filename())};
  BakeJob job{.scene = load(options.scene, options.lights, unwrap), .moves = {}, .scales = {}};
  suit_atlas(options, job.scene);
  const LitFile lit = lit_scene(options, unwrap, job.scene);
  job.scales = scales_of(job.scene, options.lights);
  // Without --live lights are from the start as they are asked for, for methods that know none, too.
  if (!options.live) {
    job.scene = scene::dimmed(std::move(job.scene), job.scales);
    job.scales = scene::full(job.scene);
  }
  scene::check_atlas(job.scene, options.settings.size);
  for (const auto& text : options.moves) job.moves.push_back(parse_move(text, job.scene));

  Baked baked = options.method.is_reference() ? bake_reference(options, job) : bake_light_field(options, job);
  std::optional<lightfield::BuriedTexels> buried;
  if (options.settings.buried == lightfield::Buried::neighbours) {
    buried.emplace(job.scene, baked.size);
    baked.report["texels_buried"] = buried->count();
  }
  const Gutters gutters(job.scene, baked.size);
  const auto finish = [&](std::vector<glm::vec4>& irradiance) {
    if (buried) buried->take_light_of_neighbours(irradiance);
    gutters.fill(irradiance);
  };
  finish(baked.irradiance);
  for (auto& light : baked.apart) finish(light.irradiance);
  files::write_exr(options.out, baked.irradiance, baked.size);
  for (const auto& [light, irradiance] : baked.apart)
    files::write_exr(std::filesystem::path(options.lights_apart) / light, irradiance, baked.size);
  if (baked.shown) files::write_bytes(options.png, stream::encode_png(baked.shown->bytes, baked.shown->size));
  write(lit.beside);
  if (!options.gltf.empty()) files::write_bytes(options.gltf, lit.glb);
  if (!options.report.empty()) files::write_text(options.report, baked.report.dump(2) + "\n");
  spdlog::info("{}: {} texels, {} bounces, {:.0f} ms on {}", options.out, baked.report["texels_valid"].dump(),
               baked.report["bounces_used"].dump(), baked.report["time_ms"]["total"].get<double>(),
               baked.report["device"].get<std::string>());
}

}  // namespace

scene::Offsets BakeJob::moved() const {
  auto offsets = at_rest();
  for (const auto& move : moves) offsets[move.body] += move.by;
  return offsets;
}

void add_bake(CLI::App& application) {
  auto* command = application.add_subcommand("bake", "Compute a scene's irradiance into a file");
  const auto options = std::make_shared<BakeOptions>();
  command->add_option("scene", options->scene, "The scene, .glb or .gltf")->required()->type_name("SCENE");
  command
      ->add_option("--out", options->out,
                   "Irradiance [W/m2]: float32 RGBA, A = 1 on valid texels; RGB goes on beyond the charts")
      ->required()
      ->type_name("E.exr");
  command
      ->add_option(
          "--gltf", options->gltf,
          "The scene with its light map, for other programs: as unwrap writes it, in the folder of --out, "
          "which its scene's extras.lightMap names")
      ->type_name("OUT.glb");
  command->add_option("--png", options->png, "What players see: tone-mapped radiance, sRGB")
      ->type_name("map.png");
  command->add_option("--report", options->report, "Device, times, memory, counts, as JSON")
      ->type_name("r.json");
  command
      ->add_option("--move", options->moves, "Shift a movable node from its rest place, metres; repeats add up")
      ->type_name("NODE=dx,dy,dz")
      ->allow_extra_args(false);
  add_light_options(*command, options->lights);
  add_keep_uv_option(*command, options->keep_uv);
  add_buried_option(*command, options->settings);
  command
      ->add_option("--lights-apart", options->lights_apart,
                   "Write what each light that switches gives, and all others together, there, as NAME.exr: a "
                   "program can scale and add them")
      ->type_name("DIR");
  auto* live =
      command->add_flag("--live", options->live,
                        "First compute with all nodes at rest and all lights full, then apply each move and "
                        "--light, as serve does");
  // Its bounces are counted from the start.
  live->excludes(command->get_option("--lights-apart"));
  command->add_option("--dump", options->dump, "Write the output of every pass there, as EXR")
      ->type_name("DIR");
  command->add_option("--dump-psf", options->dump_psf, "The direction whose A-buffer and irradiance are dumped")
      ->capture_default_str();
  add_quality_options(*command, options->settings);
  command
      ->add_option_function<std::string>(
          "--error", [options](const std::string& text) { options->error = parse_share(text); },
          "Choose --size and --psf, as far as they are not given, so that E is expected to be no farther off, "
          "as the "
          "root mean square over the mean; by trials of a few seconds")
      ->type_name("2%|0.02");
  add_bounces_option(*command, options->settings);
  add_method_option(*command, options->method, true);
  add_light_field_options(*command, options->settings);
  command->get_option("--psf")->default_str("as many as serve the method best: 96 of rays, 384 of others");
  command->add_option("--spp", options->spp, "Paths a texel of --method reference, 1..1000000")
      ->capture_default_str();
  add_device_options(*command, options->device);
  add_capture_options(*command, options->capture, "as many as leave the last");
  command->callback([options, command] {
    choose_engines(*command, options->method);
    if (command->count("--size") > 0) options->fixed.size = options->settings.size;
    if (command->count("--psf") > 0) options->fixed.psf = options->settings.psf;
    if (options->capture.after && !options->live)
      throw UsageError(
          "--capture-after counts the updates of --live, and without it there is one; leave it out");
    bake(*options);
  });
}

}  // namespace lichtveld::commands
