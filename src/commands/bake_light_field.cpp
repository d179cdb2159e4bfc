#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <set>
#include <utility>

#include "bake.hpp"
#include "lichtveld/files/output.hpp"
#include "lichtveld/lightfield/engine.hpp"
#include "report.hpp"

namespace lichtveld::commands {

namespace {

// What moves may have made of what is kept, by a look at all of it; misses are counted anew with it. Null for
// engines that keep nothing.
nlohmann::ordered_json look_again(lightfield::LightField& light, const lightfield::Settings& settings,
                                  lightfield::Solution& solution) {
  const auto check = light.check_links(settings.psf);
  if (check.links == 0) return {};
  solution.misses = check.misses;
  solution.rays_unknown = check.rays_unknown;
  return {{"checked", check.links},
          {"differing", check.differing},
          {"differing_fraction", static_cast<double>(check.differing) / static_cast<double>(check.links)}};
}

// As a server: at rest first, then a light map after every move.
void live(lightfield::LightField& light, const BakeJob& job, std::optional<gpu::Capture>& capture) {
  auto offsets = job.at_rest();
  const auto settle = [&] {
    light.settle();
    light.shown();
  };
  update(capture, settle);
  for (const auto& move : job.moves) {
    offsets[move.body] += move.by;
    light.place(offsets);
    update(capture, settle);
  }
  light.dim(job.scales);
}

// NAME.exr, another for each.
std::string file_of(const std::string& light, std::set<std::string>& taken) {
  std::string name = light.empty() ? "light" : light.substr(0, 100);
  std::ranges::replace_if(
      name, [](unsigned char c) { return !std::isalnum(c) && c != '-' && c != '_'; }, '_');
  std::string file = name + ".exr";
  for (int number = 2; !taken.insert(file).second; ++number)
    file = name + "-" + std::to_string(number) + ".exr";
  return file;
}

// Each light's part, after as many bounces as all together took: then they add up.
std::vector<Baked::OfLight> bake_apart(const lightfield::Engine& engine, const gpu::Device& device,
                                       const BakeJob& job, lightfield::Settings settings,
                                       std::uint32_t bounces) {
  settings.bounces = bounces;
  const auto light = engine.make(device, job.scene, settings);
  light->place(job.moved());
  std::vector<Baked::OfLight> apart;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < job.scene.lights.size(); ++i) {
    scene::Scales scales(job.scene.lights.size(), glm::vec3(0));
    scales[i] = glm::vec3(1);
    light->dim(scales);
    light->settle();
    apart.push_back({file_of(i == 0 ? "rest" : job.scene.lights[i].node, taken), light->irradiance()});
  }
  return apart;
}

// Of --live: at rest, and after every move. The last is what a capture is for, if nothing else is said.
std::optional<gpu::Capture> capture_for(const BakeOptions& options, const BakeJob& job) {
  const auto last = options.live ? static_cast<std::uint32_t>(job.moves.size()) : 0;
  if (options.capture.after.value_or(0) > last)
    throw UsageError("--capture-after " + std::to_string(*options.capture.after) + ": --live makes " +
                     std::to_string(last + 1) + " updates, one at rest and one a move; choose 0.." +
                     std::to_string(last));
  return make_capture(options.capture, last);
}

lightfield::LightField::StageObserver dump_into(const std::filesystem::path& folder) {
  return [folder](const std::string& stage, const lightfield::TexelView& image) {
    files::write_exr(folder / (stage + ".exr"), image.on_host(), image.width());
  };
}

// The quickest light map that is exact enough; says what to expect of it.
void choose_quality(const BakeOptions& options, const lightfield::Engine& engine, const gpu::Device& device,
                    const scene::Scene& scene, lightfield::Settings& settings) {
  lightfield::Forecast forecast(engine, device, scene, settings, options.fixed, [] { return false; });
  const auto expected = forecast.quickest_for(*options.error);
  settings.size = expected.quality.size;
  settings.psf = expected.quality.psf;
  spdlog::info("--size {} --psf {}: {:.1f} % off, in {:.1f} s", settings.size, settings.psf,
               100 * expected.error, expected.first_ms / 1000);
  if (expected.error > *options.error)
    spdlog::warn("nothing finer is to be chosen from, and {:.1f} % was asked for; try --method reference",
                 100 * *options.error);
}

}  // namespace

Baked bake_light_field(const BakeOptions& options, const BakeJob& job) {
  auto capture = capture_for(options, job);
  const gpu::Device device(options.device);
  const auto start = std::chrono::steady_clock::now();
  auto total = std::make_unique<gpu::TimeLedger::Stage>(device.times(), "rest");
  auto settings = options.settings;
  const auto& engine = engine_of(options.method, device, job.scene, settings);
  if (options.error) choose_quality(options, engine, device, job.scene, settings);
  const auto light = device.times().time("set_up", [&] { return engine.make(device, job.scene, settings); });
  if (options.live) live(*light, job, capture);
  if (!options.dump.empty()) light->observe(dump_into(options.dump), options.dump_psf);
  light->place(job.moved());
  lightfield::Solution solution;
  lightfield::Shown shown;
  const auto settle = [&] {
    solution = light->settle();
    shown = light->shown();
  };
  // What --live has computed is only looked at once more.
  options.live ? settle() : update(capture, settle);
  Baked baked{.size = settings.size, .irradiance = light->irradiance(), .shown = {}, .apart = {}, .report = {}};
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  total.reset();

  const auto times = light->times();
  if (!options.png.empty()) baked.shown = std::move(shown);
  const auto links = options.live ? look_again(*light, settings, solution) : nlohmann::ordered_json();
  baked.report = report(device, engine.name, settings, solution, times, took.count());
  if (!links.empty()) baked.report["links"] = links;
  if (!options.lights_apart.empty()) baked.apart = bake_apart(engine, device, job, settings, solution.bounces);
  check_validation(device);
  return baked;
}

}  // namespace lichtveld::commands
