#include "updates.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <chrono>
#include <cmath>

#include "lichtveld/lightfield/engine.hpp"
#include "lichtveld/scene/motion.hpp"
#include "sweep.hpp"

namespace lichtveld::bench {

namespace {

using Clock = std::chrono::steady_clock;

// A rest of a step before a wall is no step: the light hardly changes.
constexpr float least_share_of_a_step = 0.5f;
constexpr std::uint64_t seed_of_truth = 1;
// The thesis computes everything afresh, and so takes as long for any step: for seconds each.
constexpr std::size_t steps_of_thesis = 3;

// What links leaves to choose.
struct Choice {
  std::string options;
  void (*make)(lightfield::Settings&);
};
const std::array<Choice, 4> choices = {{
    {"--step-bounces 0.25", [](lightfield::Settings& settings) { settings.links.step_bounces = 0.25f; }},
    {"--step-bounces 0.5", [](lightfield::Settings& settings) { settings.links.step_bounces = 0.5f; }},
    {"--step-bounces 1", [](lightfield::Settings& settings) { settings.links.step_bounces = 1; }},
    {"--step-bounces 2", [](lightfield::Settings& settings) { settings.links.step_bounces = 2; }},
}};

std::string known(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}

// As serve has it while things move: the light of further bounces follows in the next steps.
bool after_the_step(std::uint32_t) {
  return true;
}

UpdateRow run_walk(const gpu::Device& device, const scene::Scene& scene, UpdateRow row,
                   const std::vector<scene::Offsets>& places, const reference::Irradiance* truth) {
  const auto light = lightfield::make_light_field(row.method, device, scene, row.settings);
  light->settle();
  const auto steps = row.method == thesis_method ? std::min(places.size(), steps_of_thesis) : places.size();
  const auto before = light->times();
  for (std::size_t step = 0; step < steps; ++step) {
    const auto start = Clock::now();
    light->place(places[step]);
    light->step(after_the_step);
    row.ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  row.passes = (light->times() - before).passes;
  if (truth != nullptr) {
    if (steps == places.size())
      row.rel_rmse_moving = reference::error_of(light->irradiance(), truth->texels).rel_rmse;
    light->place(places.back());
    light->settle();
    row.rel_rmse = reference::error_of(light->irradiance(), truth->texels).rel_rmse;
    row.noise_of_truth = reference::expected_rel_rmse(*truth);
  }
  return row;
}

}  // namespace

std::vector<scene::Offsets> walk(const scene::Scene& scene, std::uint32_t steps) {
  if (scene.bodies.size() < 2) return {};
  const float length = scene::step_length(scene);
  const std::array<glm::vec3, 4> ways = {glm::vec3(length, 0, 0), glm::vec3(0, length, 0),
                                         glm::vec3(-length, 0, 0), glm::vec3(0, -length, 0)};
  std::vector<scene::Offsets> places;
  scene::Offsets now(scene.bodies.size(), glm::vec3(0));
  std::size_t way = 0;
  while (places.size() < steps) {
    std::size_t turns = 0;
    glm::vec3 step(0);
    for (; turns < ways.size(); ++turns, way = (way + 1) % ways.size()) {
      step = scene::free_step(scene, now, 1, ways[way]);
      if (glm::length(step) >= least_share_of_a_step * length) break;
    }
    if (turns == ways.size()) return {};
    now[1] += step;
    places.push_back(now);
  }
  return places;
}

std::vector<UpdateRow> time_updates(const gpu::Device& device, const scene::Scene& scene,
                                    const std::string& name, const UpdateOptions& options,
                                    const ReferenceCache& cache) {
  const auto places = walk(scene, options.steps);
  if (places.empty()) {
    spdlog::warn("{}: no updates are timed: {}", scene.file,
                 scene.bodies.size() < 2 ? "no node has extras.movable"
                                         : "\"" + scene.bodies[1].node + "\" is blocked on every side");
    return {};
  }
  std::vector<UpdateRow> rows;
  for (const auto& settings : options.settings) {
    std::optional<reference::Irradiance> truth;
    if (!is_dark(scene))
      truth = cache.traced(scene, places.back(),
                           {.size = settings.size,
                            .bounces = settings.bounces,
                            .spp = options.truth_spp,
                            .seed = seed_of_truth});
    double of_thesis = not_known;
    const auto run = [&](UpdateRow row) {
      row.scene = name;
      row = run_walk(device, scene, std::move(row), places, truth ? &*truth : nullptr);
      const double p50 = median(row.ms);
      if (row.method == thesis_method) of_thesis = p50;
      row.speedup_vs_thesis = of_thesis / p50;
      spdlog::info("{} {} {} size {} psf {}: {} updates, {:.0f} ms each", name, row.method, row.choice,
                   settings.size, settings.psf, row.ms.size(), p50);
      rows.push_back(std::move(row));
    };
    for (const auto& engine : lightfield::engines())
      run({.scene = {}, .method = engine.name, .settings = settings});
    for (const auto& choice : choices) {
      auto changed = settings;
      choice.make(changed);
      run({.scene = {}, .method = links_method, .settings = changed, .choice = choice.options});
    }
  }
  return rows;
}

std::string updates_csv(const std::vector<UpdateRow>& rows) {
  std::string csv = "method,size,psf,ms_p50,ms_p95,speedup_vs_thesis,rel_rmse,scene,steps,rel_rmse_moving\n";
  for (const auto& row : rows)
    if (row.choice.empty())
      csv += fmt::format("{},{},{},{:.4f},{:.4f},{:.3f},{},{},{},{}\n", row.method, row.settings.size,
                         row.settings.psf, median(row.ms), percentile(row.ms, 0.95), row.speedup_vs_thesis,
                         known(row.rel_rmse), csv_cell(row.scene), row.ms.size(), known(row.rel_rmse_moving));
  return csv;
}

std::string choices_csv(const std::vector<UpdateRow>& rows) {
  std::string csv = "scene,size,psf,choice,ms_p50,ms_p95,rel_rmse,rel_rmse_moving\n";
  for (const auto& row : rows)
    if (row.method == links_method)
      csv += fmt::format("{},{},{},{},{:.4f},{:.4f},{},{}\n", csv_cell(row.scene), row.settings.size,
                         row.settings.psf, row.choice.empty() ? "default" : row.choice, median(row.ms),
                         percentile(row.ms, 0.95), known(row.rel_rmse), known(row.rel_rmse_moving));
  return csv;
}

std::string updates_text(const std::vector<UpdateRow>& rows) {
  std::string text;
  for (const auto& row : rows) {
    text += fmt::format(
        "  {:<12} {:<8} --size {:<4} --psf {:<5} median {:9.1f} ms, 95 % below {:9.1f} ms, {:5.2f} "
        "times as fast as thesis",
        row.scene, row.method + (row.choice.empty() ? "" : " " + row.choice), row.settings.size,
        row.settings.psf, median(row.ms), percentile(row.ms, 0.95), row.speedup_vs_thesis);
    if (std::isfinite(row.rel_rmse))
      text += fmt::format(", rel_rmse {:.2f} % (reference's noise {:.2f} %)", 100 * row.rel_rmse,
                          100 * row.noise_of_truth);
    if (std::isfinite(row.rel_rmse_moving))
      text += fmt::format(", {:.2f} % while moving", 100 * row.rel_rmse_moving);
    text += "\n   ";
    for (const auto& [name, time] : row.passes)
      text += fmt::format(" {} {:.1f}", name, time.gpu_ms / static_cast<double>(row.ms.size()));
    text += " ms a step\n";
  }
  return text;
}

}  // namespace lichtveld::bench
