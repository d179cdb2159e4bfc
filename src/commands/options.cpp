#include "options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "lichtveld/files/output.hpp"
#include "lichtveld/lightfield/choice.hpp"
#include "lichtveld/lightfield/directions.hpp"

namespace lichtveld::commands {

namespace {

// An option whose values are the keys of `names`.
template <typename Value>
void add_choice(CLI::App& command, const std::string& option, Value& value,
                const std::map<std::string, Value>& names, const std::string& help) {
  std::string choices;
  for (const auto& [name, unused] : names) choices += (choices.empty() ? "" : "|") + name;
  command
      .add_option_function<std::string>(
          option,
          [&value, names, option, choices](const std::string& text) {
            const auto found = names.find(text);
            if (found == names.end()) throw UsageError(option + " " + text + ": choose one of " + choices);
            value = found->second;
          },
          help)
      ->type_name(choices)
      ->default_str(std::ranges::find(names, value, [](const auto& entry) { return entry.second; })->first);
}

// What means something to some methods alone.
struct OptionOfMethods {
  const char* option;
  std::vector<std::string> methods;
};
const std::vector<OptionOfMethods> options_of_methods = {
    {"--abuffer", {"thesis"}},
    {"--sort", {"thesis"}},
    {"--dump", {"thesis"}},
    {"--dump-psf", {"thesis"}},
    {"--layers", {"thesis", "links"}},
    {"--psf-size", {"thesis", "links"}},
    {"--weights", {"thesis", "links"}},
    {"--capture", {"thesis", "links"}},
    {"--step-bounces", {"links"}},
    {"--sets", {"rays"}},
    {"--direct", {"thesis", "links", "rays"}},
    {"--psf", {"thesis", "links", "rays"}},
    {"--error", {"thesis", "links", "rays"}},
    {"--memory", {"links", "rays"}},
    {"--live", {"thesis", "links", "rays"}},
    {"--lights-apart", {"thesis", "links", "rays"}},
    {"--spp", {reference_method}},
};

}  // namespace

void add_buried_option(CLI::App& command, lightfield::Settings& settings) {
  add_choice(command, "--buried", settings.buried, lightfield::words_of_burieds(),
             "Texels inside of what stands there, as of a floor in a wall that goes through it: the light of "
             "their visible neighbours, or lit as if it were not there");
}

void add_keep_uv_option(CLI::App& command, bool& keep_uv) {
  command.add_flag("--keep-uv", keep_uv,
                   "Refuse a scene whose TEXCOORD_1 is missing or cannot be used, instead of unwrapping it");
}

void check(const scene::UnwrapOptions& options) {
  if (options.size < 16 || options.size > 4096)
    throw UsageError("--size " + std::to_string(options.size) + ": texels a side, 16..4096");
  if (!(options.texels_per_metre >= 0 && options.texels_per_metre <= 1e6))
    throw UsageError("--texels-per-metre: a number above 0, as in 20");
}

void add_device_options(CLI::App& command, gpu::DeviceOptions& options) {
  command
      .add_option(
          "--device", options.device,
          "The Vulkan device: a number of `lichtveld info` or a part of its name (default: a GPU before a CPU)")
      ->envname("LICHTVELD_DEVICE");
  command
      .add_flag(
          "--validation", options.validation,
          "Run under the Vulkan validation layers, synchronization validation too; any message is an error")
      ->envname("LICHTVELD_VALIDATION");
}

void check_validation(const gpu::Device& device) {
  const auto messages = device.validation_messages();
  if (!messages.empty())
    throw std::runtime_error("the validation layers had " + std::to_string(messages.size()) +
                             " complaints (above): a bug, please report it with this command line");
}

void add_capture_options(CLI::App& command, CaptureOptions& options, const std::string& after) {
  auto* capture = command
                      .add_option("--capture", options.file,
                                  "Let RenderDoc capture an update of the light into this file; needs the "
                                  "package librenderdoc")
                      ->type_name("FILE.rdc");
  command.add_option("--capture-after", options.after, "Updates of the light before the one that is captured")
      ->type_name("N")
      ->default_str(after)
      ->needs(capture);
}

void check(const CaptureOptions& options) {
  if (!options.file.empty()) files::check_place(options.file, ".rdc");
}

std::optional<gpu::Capture> make_capture(const CaptureOptions& options, std::uint32_t after_by_default) {
  if (options.file.empty()) return {};
  return std::make_optional<gpu::Capture>(files::target_of(options.file),
                                          options.after.value_or(after_by_default));
}

void update(std::optional<gpu::Capture>& capture, const std::function<void()>& work) {
  capture ? capture->around(work) : work();
}

void add_method_option(CLI::App& command, Method& method, bool with_reference) {
  std::map<std::string, std::string> names;
  std::string help;
  const auto add = [&](const std::string& name, const std::string& summary) {
    names[name] = name;
    help += (help.empty() ? "" : "; ") + name + ": " + summary;
  };
  add(method.name, "rays on a CPU, on a GPU what a short trial finds better");
  for (const auto& engine : lightfield::engines()) add(engine.name, engine.summary);
  if (with_reference) add(reference_method, "path tracing on the CPU, the truth to compare with");
  add_choice(command, "--method", method.name, names, help);
}

void choose_engines(const CLI::App& command, Method& method) {
  std::vector<std::string> left;
  for (const auto& engine : lightfield::engines())
    if (method.name == Method{}.name || method.name == engine.name) left.emplace_back(engine.name);
  if (method.is_reference()) left = {reference_method};
  for (const auto& [option, methods] : options_of_methods) {
    const auto* used = command.get_option_no_throw(option);
    if (used == nullptr || used->count() == 0) continue;
    const auto lacks = [&, known = std::span(methods)](const std::string& name) {
      return std::ranges::find(known, name) == known.end();
    };
    std::erase_if(left, lacks);
    if (!left.empty()) continue;
    throw UsageError(std::string(option) + " means nothing to --method " + method.name + " here, but to " +
                     fmt::format("{}", fmt::join(methods, ", ")) + "; leave it out");
  }
  method.own_psf = command.count("--psf") == 0;
  for (const auto& engine : lightfield::engines())
    if (std::ranges::find(left, engine.name) != left.end()) method.engines.push_back(&engine);
}

const lightfield::Engine& engine_of(const Method& method, const gpu::Device& device, const scene::Scene& scene,
                                    lightfield::Settings& settings) {
  const auto& engine = lightfield::suited(method.engines, device, scene, settings);
  if (method.own_psf) settings.psf = engine.psf;
  return engine;
}

void add_light_field_options(CLI::App& command, lightfield::Settings& settings) {
  add_choice(command, "--abuffer", settings.thesis.abuffer, lightfield::words_of_abuffers(),
             "Of --method thesis: how a PSF keeps all its layers: routed by the stencil to "
             "the samples of a pixel, or in a list of "
             "each pixel");
  add_choice(command, "--sort", settings.thesis.sort, lightfield::words_of_sorts(),
             "Of --method thesis: how a texel finds its layer: sorting them, or scanning for "
             "the nearest in front");
  command
      .add_option("--sets", settings.rays.sets,
                  "Of --method rays: sets of directions that neighbouring texels share out: 16, 4, or 1: all "
                  "look along the "
                  "same ones")
      ->capture_default_str();
  command
      .add_option("--memory", settings.memory,
                  "What links may take, as 500M or 2G; more is refused before it is taken")
      ->transform(CLI::AsSizeValue(false))
      ->type_name("SIZE")
      ->default_str("three quarters of what is free");
  command
      .add_option_function<std::string>(
          "--direct",
          [&settings](const std::string& text) {
            const auto& words = lightfield::words_of_directs();
            if (!words.contains(text)) throw UsageError("--direct " + text + ": choose one of exact|psf");
            settings.direct = words.at(text);
          },
          "Light straight from lamps: exact, in closed form with shadows by sample points; psf: by the "
          "directions, "
          "as all other light")
      ->type_name("exact|psf")
      ->default_str("exact; psf of --method thesis");
  command
      .add_option(
          "--layers", settings.layers,
          "Layers that a PSF pixel keeps, 1..128; pixels with more are counted, and room is made for them")
      ->capture_default_str();
}

void add_quality_options(CLI::App& command, lightfield::Settings& settings) {
  command.add_option("--size", settings.size, "Texels a side of the light map, 16..4096")
      ->capture_default_str();
  command.add_option("--psf", settings.psf, "Directions: " + lightfield::direction_counts_text())
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--psf-size",
          [&settings](const std::string& text) {
            settings.psf_size = parse_psf_size(text).pixels(settings.size);
          },
          "Pixels a side of a PSF's raster, or how many a texel of the light map has: 2x is nearly as exact as "
          "ray casting, and takes up to four times as long")
      ->type_name("N|Fx")
      ->default_str("1x");
  add_choice(
      command, "--weights", settings.weights, lightfield::words_of_weights(),
      "What a direction counts for: its solid angle (the thesis' correction factor), or the same for all");
  command
      .add_option("--seed", settings.seed,
                  "Of all that is random: rotations and rasters of the directions, paths of the reference")
      ->capture_default_str();
}

lightfield::PsfSize parse_psf_size(const std::string& text) {
  lightfield::PsfSize size{.times = text.ends_with('x')};
  const auto number = size.times ? text.substr(0, text.size() - 1) : text;
  if (!CLI::detail::lexical_cast(number, size.value) || !(size.value > 0 && size.value <= 8192) ||
      (!size.times && size.value != std::floor(size.value)))
    throw UsageError("--psf-size " + text +
                     ": a number of pixels a side, 16..8192, or as in 2x of times the size");
  return size;
}

double parse_share(const std::string& text) {
  const bool percent = text.ends_with('%');
  double value = 0;
  if (!CLI::detail::lexical_cast(percent ? text.substr(0, text.size() - 1) : text, value) ||
      !(value > 0 && std::isfinite(value)))
    throw UsageError("--error " + text + ": a share above 0, as 2% or 0.02");
  return percent ? value / 100 : value;
}

std::optional<std::uint32_t> parse_bounces(const std::string& text) {
  if (text == "auto") return {};
  std::uint32_t bounces = 0;
  if (!CLI::detail::lexical_cast(text, bounces) || bounces < 1 || text.front() == '-')
    throw UsageError("--bounces " + text + ": a number from 1 (direct light), or auto");
  return bounces;
}

void add_step_bounces_option(CLI::App& command, lightfield::Settings& settings) {
  command
      .add_option(
          "--step-bounces", settings.links.step_bounces,
          "Of --method links: bounces of the map after a move, 1.., or 0.5, 0.25 or 0.125: one over that share "
          "of the directions, in turn; what is missing follows with the next maps. Light straight from lamps "
          "is always there, and all light beside what has moved")
      ->capture_default_str();
}

void add_bounces_option(CLI::App& command, lightfield::Settings& settings) {
  command
      .add_option_function<std::string>(
          "--bounces", [&settings](const std::string& text) { settings.bounces = parse_bounces(text); },
          "Path segments up to a texel: 1 is direct light; auto: until less than 0.1 % of the mean can be "
          "missing")
      ->type_name("auto|N")
      ->default_str(settings.bounces ? std::to_string(*settings.bounces) : "auto");
}

}  // namespace lichtveld::commands
