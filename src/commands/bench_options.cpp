#include "bench_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "lichtveld/lightfield/directions.hpp"

namespace lichtveld::commands {

namespace {

using lightfield::ABuffer;
using lightfield::Sort;
using lightfield::Weights;
using Counts = std::vector<std::uint32_t>;

// The values that --quick replaces: fewer and smaller, to end within two minutes on two cores.
struct Effort {
  Counts sizes, psfs, update_psfs, path_spps;
  std::uint32_t repeats, truth_spp, updates;
};
const Effort usual = {.sizes = {128, 256},
                      .psfs = {24, 96, 384, 1536},
                      .update_psfs = {96, 384},
                      .path_spps = {1, 4, 16, 64},
                      .repeats = 3,
                      .truth_spp = 4096,
                      .updates = 60};
const Effort quick = {.sizes = {128},
                      .psfs = {24, 96, 384},
                      .update_psfs = {96},
                      .path_spps = {1, 4, 16, 64},
                      .repeats = 2,
                      .truth_spp = 2048,
                      .updates = 10};

std::string text_of(const Counts& values) {
  return fmt::format("{}", fmt::join(values, ","));
}

// "N", and what --quick makes of it.
std::string defaults(const std::string& usually, const std::string& quickly) {
  return usually + "; with --quick " + quickly;
}

CLI::Option* add_counts(CLI::App& command, const std::string& option, Counts& values, const Counts& usually,
                        const Counts& quickly, const std::string& help) {
  return command.add_option(option, values, help)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("N,..")
      ->default_str(defaults(text_of(usually), text_of(quickly)));
}

CLI::Option* add_count(CLI::App& command, const std::string& option, std::uint32_t& value,
                       std::uint32_t usually, std::uint32_t quickly, const std::string& help) {
  return command.add_option(option, value, help)
      ->type_name("N")
      ->default_str(defaults(std::to_string(usually), std::to_string(quickly)));
}

// A list of words; parse(word) throws UsageError for what it does not know.
template <typename Value, typename Parse>
CLI::Option* add_words(CLI::App& command, const std::string& option, std::vector<Value>& values, Parse parse,
                       const std::string& help) {
  return command
      .add_option_function<std::vector<std::string>>(
          option,
          [&values, parse](const std::vector<std::string>& words) {
            values.clear();
            for (const auto& word : words) values.push_back(parse(word));
          },
          help)
      ->delimiter(',')
      ->allow_extra_args(false);
}

template <typename Value, typename Name>
auto one_of(const std::string& option, const std::vector<Value>& choices, Name name) {
  return [=](const std::string& word) {
    std::string names;
    for (const auto choice : choices) {
      if (name(choice) == word) return choice;
      names += (names.empty() ? "" : "|") + name(choice);
    }
    throw UsageError(option + " " + word + ": choose among " + names + ", with commas between them");
  };
}

template <typename Value>
void each_once(const std::string& option, std::vector<Value>& values) {
  std::vector<Value> once;
  for (const auto& value : values)
    if (std::find(once.begin(), once.end(), value) == once.end()) once.push_back(value);
  values = std::move(once);
  if (values.empty()) throw UsageError(option + ": at least one value");
}

}  // namespace

void add_bench_options(CLI::App& command, BenchOptions& options) {
  auto& sweep = options.bench.sweep;
  command.add_option("--scene", options.bench.scenes, "Scenes, .glb or .gltf; repeat it for several")
      ->capture_default_str()
      ->allow_extra_args(false)
      ->type_name("FILE");
  command.add_option("--out", options.bench.out, "The folder for the tables (.csv) and charts (.svg, .png)")
      ->capture_default_str()
      ->type_name("DIR");
  command.add_flag("--quick", options.quick, "Fewer and smaller light maps: two minutes on two cores");
  command.add_flag(
      "--scale", options.bench.scale,
      "Instead: what rays cost in rooms of 1,000 to 1,000,000 triangles, on one core and on all, at the "
      "last --size");
  command
      .add_flag("--lamps", options.bench.lamps,
                "Instead: how near each method comes by how large the lamp is, from the whole ceiling to a "
                "candle, at the last --size")
      ->excludes("--scale");
  add_counts(command, "--size", sweep.sizes, usual.sizes, quick.sizes, "Texels a side, 16..4096");
  add_counts(command, "--psf", sweep.psfs, usual.psfs, quick.psfs,
             "Directions: " + lightfield::direction_counts_text());
  add_words(
      command, "--bounces", sweep.bounces, [](const std::string& word) { return parse_bounces(word); },
      "Path segments up to a texel: 1 is direct light; auto: until less than 0.1 % of the mean can be missing")
      ->type_name("auto|N,..")
      ->default_str("2");
  add_words(
      command, "--abuffer", sweep.abuffers,
      one_of<ABuffer>("--abuffer", {ABuffer::stencil, ABuffer::list}, [](ABuffer a) { return name_of(a); }),
      "How a PSF keeps its layers")
      ->type_name("stencil|list,..")
      ->default_str("stencil,list");
  add_words(command, "--sort", sweep.sorts,
            one_of<Sort>("--sort", {Sort::bitonic, Sort::compare_swap, Sort::scan},
                         [](Sort s) { return name_of(s); }),
            "How a texel finds its layer")
      ->type_name("bitonic|compare-swap|scan,..")
      ->default_str(fmt::format("all up to {} directions, then compare-swap for stencil and scan for list",
                                bench::all_sorts_up_to));
  add_words(
      command, "--psf-size", sweep.psf_sizes, parse_psf_size,
      "Pixels a side of a PSF, or as in 2x so many for each texel of the atlas' side. The first goes with "
      "every row, others only with the last A-buffer")
      ->type_name("N|Fx,..")
      ->default_str(defaults("1x,2x", "1x"));
  add_words(
      command, "--weights", sweep.weights,
      one_of<Weights>("--weights", {Weights::solid_angle, Weights::equal},
                      [](Weights w) { return name_of(w); }),
      "What a direction counts for: its solid angle, or as much as any other. The first goes with every row, "
      "others only with the last A-buffer")
      ->type_name("solid-angle|equal,..")
      ->default_str("solid-angle,equal");
  add_count(command, "--repeats", sweep.repeats, usual.repeats, quick.repeats,
            "Runs of each row, of which medians are reported; a row that has taken 10 s is not run again");
  add_count(command, "--spp", sweep.truth_spp, usual.truth_spp, quick.truth_spp,
            "Paths a texel of the reference, the truth that errors are measured against, 2..1000000");
  add_counts(command, "--path-spp", sweep.path_spps, usual.path_spps, quick.path_spps,
             "Paths a texel of path tracing as a method to compare with; 0: none");
  command
      .add_option("--reference-cache", options.bench.reference_cache,
                  "Where references are kept, for they take minutes; they may be deleted at any time")
      ->type_name("DIR")
      ->default_str(bench::default_reference_cache().string());
  add_count(
      command, "--updates", options.bench.updates, usual.updates, quick.updates,
      fmt::format("Steps of the first movable body, with a light map after each; 0: none. With {} directions "
                  "unless --psf says otherwise",
                  text_of(usual.update_psfs)));
  add_device_options(command, options.device);
}

void complete(const CLI::App& command, BenchOptions& options) {
  const auto& effort = options.quick ? quick : usual;
  auto& sweep = options.bench.sweep;
  const auto fill = [&](const std::string& option, auto& value, const auto& otherwise) {
    if (command.count(option) == 0) value = otherwise;
  };
  fill("--psf", options.bench.update_psfs, effort.update_psfs);
  fill("--size", sweep.sizes, effort.sizes);
  fill("--psf", sweep.psfs, effort.psfs);
  fill("--path-spp", sweep.path_spps, effort.path_spps);
  fill("--repeats", sweep.repeats, effort.repeats);
  fill("--spp", sweep.truth_spp, effort.truth_spp);
  fill("--updates", options.bench.updates, effort.updates);
  fill("--bounces", sweep.bounces, std::vector<std::optional<std::uint32_t>>{2});
  fill("--abuffer", sweep.abuffers, std::vector{ABuffer::stencil, ABuffer::list});
  fill("--weights", sweep.weights, std::vector{Weights::solid_angle, Weights::equal});
  fill("--psf-size", sweep.psf_sizes,
       options.quick ? std::vector<lightfield::PsfSize>{{1, true}}
                     : std::vector<lightfield::PsfSize>{{1, true}, {2, true}});
  fill("--reference-cache", options.bench.reference_cache, bench::default_reference_cache().string());

  each_once("--size", sweep.sizes);
  each_once("--psf", sweep.psfs);
  each_once("--bounces", sweep.bounces);
  each_once("--abuffer", sweep.abuffers);
  each_once("--psf-size", sweep.psf_sizes);
  each_once("--weights", sweep.weights);
  if (command.count("--sort") > 0) each_once("--sort", sweep.sorts);
  std::erase(sweep.path_spps, 0u);
  if (command.count("--psf") > 0) options.bench.update_psfs = sweep.psfs;
  if (sweep.repeats < 1) throw UsageError("--repeats 0: at least 1");
  if (sweep.truth_spp < 2) throw UsageError("--spp " + std::to_string(sweep.truth_spp) + ": 2..1000000");

  std::set<std::string> names;
  for (const auto& scene : options.bench.scenes)
    if (const auto name = std::filesystem::path(scene).stem().string(); !names.insert(name).second)
      throw UsageError("--scene " + scene +
                       ": tables and charts tell scenes by their file's name, and there are two " + name);
}

}  // namespace lichtveld::commands
