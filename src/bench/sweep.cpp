#include "sweep.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <set>
#include <tuple>

#include "lichtveld/lightfield/directions.hpp"
#include "lichtveld/lightfield/engine.hpp"
#include "lichtveld/progress/progress.hpp"
#include "lichtveld/scene/lights.hpp"

namespace lichtveld::bench {

namespace {

using lightfield::ABuffer;
using lightfield::Settings;
using lightfield::Sort;
using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

// A row whose runs took so long together is known well enough: disturbances are short [ms].
constexpr double long_enough = 10'000;
// Path tracing as a method draws other numbers than the truth, or it would find part of itself there.
constexpr std::uint64_t seed_of_truth = 1, seed_of_paths = 2;

std::vector<Sort> sorts_for(ABuffer abuffer, std::uint32_t psf, const SweepOptions& options) {
  if (!options.sorts.empty()) return options.sorts;
  if (psf <= all_sorts_up_to) return {Sort::bitonic, Sort::compare_swap, Sort::scan};
  return {own_sort(abuffer)};
}

// The sort of an A-buffer's curve.
Sort curve_sort(ABuffer abuffer, const SweepOptions& options) {
  const auto& sorts = options.sorts;
  const bool has_own = sorts.empty() || std::find(sorts.begin(), sorts.end(), own_sort(abuffer)) != sorts.end();
  return has_own ? own_sort(abuffer) : sorts.front();
}

// Error maps show one size, one A-buffer: the others' need not be kept.
bool is_shown(const Row& row, const SweepOptions& options) {
  return row.settings.size == *std::max_element(options.sizes.begin(), options.sizes.end()) &&
         row.settings.bounces == options.bounces.front() &&
         row.settings.thesis.abuffer == options.abuffers.back() &&
         row.settings.thesis.sort == curve_sort(row.settings.thesis.abuffer, options);
}

void measure(Row& row, const gpu::Device& device, const scene::Scene& scene) {
  const auto light = lightfield::make_light_field(row.method, device, scene, row.settings);
  const auto before = light->times();
  const auto start = Clock::now();
  const auto& solution = light->settle();
  row.total_ms.push_back(Milliseconds(Clock::now() - start).count());
  row.passes.push_back((light->times() - before).passes);
  row.bounces_used = solution.bounces;
  row.error_estimate = solution.error_estimate;
  row.map = light->irradiance();
}

const Truth* truth_for(const Row& row, const std::vector<Truth>& truths) {
  for (const auto& truth : truths)
    if (truth.size == row.settings.size && truth.bounces == row.settings.bounces) return &truth;
  return nullptr;
}

void compare(Row& row, const std::vector<Truth>& truths) {
  if (const auto* truth = truth_for(row, truths)) row.error = reference::error_of(row.map, truth->light.texels);
}

// Drivers compile on the first use: not in a run that is timed.
void warm_up(const std::vector<Row>& rows, const gpu::Device& device, const scene::Scene& scene) {
  std::set<std::tuple<std::string, ABuffer, Sort, std::uint32_t, lightfield::Weights>> known;
  for (const auto& row : rows) {
    auto settings = row.settings;
    if (!known
             .insert(
                 {row.method, settings.thesis.abuffer, settings.thesis.sort, settings.size, settings.weights})
             .second)
      continue;
    settings.psf = lightfield::direction_counts().front();
    settings.bounces = 1;
    lightfield::make_light_field(row.method, device, scene, settings)->settle();
  }
}

// Whole rounds, so that a disturbance of the machine does not fall on one row alone.
void measure_all(std::vector<Row>& rows, const std::vector<Truth>& truths, const gpu::Device& device,
                 const scene::Scene& scene, const SweepOptions& options) {
  progress::Work work("measurements", options.repeats * rows.size());
  warm_up(rows, device, scene);
  for (std::uint32_t repeat = 0; repeat < options.repeats; ++repeat)
    for (auto& row : rows) {
      work.done();
      if (std::accumulate(row.total_ms.begin(), row.total_ms.end(), 0.0) > long_enough) continue;
      measure(row, device, scene);
      compare(row, truths);
      if (!is_shown(row, options)) row.map.clear();
      spdlog::info("{} {} {} {} size {} psf {}: {:.0f} ms, rel_rmse {:.2f} %", row.scene, row.method,
                   name_of(row.settings.thesis.abuffer), name_of(row.settings.thesis.sort), row.settings.size,
                   row.settings.psf, row.total_ms.back(), 100 * row.error.rel_rmse);
    }
}

Truth trace_truth(const scene::Scene& scene, const std::string& name, std::uint32_t size,
                  std::optional<std::uint32_t> bounces, std::uint32_t spp, const ReferenceCache& cache) {
  Truth truth{.scene = name, .size = size, .bounces = bounces, .light = {}, .noise = 0, .spp = spp};
  truth.light = cache.traced(scene, {}, {.size = size, .bounces = bounces, .spp = spp, .seed = seed_of_truth});
  truth.noise = reference::expected_rel_rmse(truth.light);
  return truth;
}

Row trace_paths(const scene::Scene& scene, const Truth& truth, std::uint32_t spp) {
  Row row{.scene = truth.scene,
          .method = reference_method,
          .settings = {.size = truth.size, .bounces = truth.bounces},
          .spp = spp};
  const auto start = Clock::now();
  const auto light = reference::trace(
      scene, {}, {.size = truth.size, .bounces = truth.bounces, .spp = spp, .seed = seed_of_paths});
  row.total_ms.push_back(Milliseconds(Clock::now() - start).count());
  row.error = reference::error_of(light.texels, truth.light.texels);
  return row;
}

}  // namespace

std::vector<Row> rows_of(const std::string& scene, const SweepOptions& options) {
  std::vector<Row> rows;
  const auto add = [&](const std::string& method, Settings settings, lightfield::PsfSize psf_size, bool side) {
    settings.psf_size = psf_size.pixels(settings.size);
    lightfield::check(settings);
    rows.push_back({.scene = scene, .method = method, .settings = settings, .side = side});
  };
  for (const auto& engine : lightfield::engines())
    for (const auto bounces : options.bounces)
      for (const auto size : options.sizes)
        for (const auto psf : options.psfs) {
          Settings settings{.size = size, .psf = psf, .bounces = bounces};
          const std::string method = engine.name;
          if (method != thesis_method) {  // has one way to find layers
            settings = curve_settings(ABuffer::list, size, psf, options);
            settings.bounces = bounces;
            add(method, settings, options.psf_sizes.front(), false);
            continue;
          }
          settings.weights = options.weights.front();
          for (const auto abuffer : options.abuffers)
            for (const auto sort : sorts_for(abuffer, psf, options)) {
              settings.thesis.abuffer = abuffer;
              settings.thesis.sort = sort;
              add(method, settings, options.psf_sizes.front(), false);
            }
          settings.thesis.sort = curve_sort(settings.thesis.abuffer, options);
          for (std::size_t i = 1; i < options.psf_sizes.size(); ++i)
            add(method, settings, options.psf_sizes[i], true);
          for (std::size_t i = 1; i < options.weights.size(); ++i) {
            settings.weights = options.weights[i];
            add(method, settings, options.psf_sizes.front(), true);
          }
        }
  return rows;
}

Settings curve_settings(ABuffer abuffer, std::uint32_t size, std::uint32_t psf, const SweepOptions& options) {
  Settings settings{.size = size, .psf = psf, .bounces = options.bounces.front()};
  settings.thesis.abuffer = abuffer;
  settings.thesis.sort = curve_sort(abuffer, options);
  settings.psf_size = options.psf_sizes.front().pixels(size);
  settings.weights = options.weights.front();
  return settings;
}

void append(SweepResult& all, SweepResult&& more) {
  std::move(more.rows.begin(), more.rows.end(), std::back_inserter(all.rows));
  std::move(more.truths.begin(), more.truths.end(), std::back_inserter(all.truths));
}

bool is_dark(const scene::Scene& scene) {
  return !scene::has_light(scene);
}

SweepResult sweep(const gpu::Device& device, const scene::Scene& scene, const std::string& name,
                  std::vector<Row> rows, const SweepOptions& options, const ReferenceCache& cache) {
  SweepResult result;
  if (is_dark(scene))
    spdlog::warn("{}: nothing glows, so errors, which are shares of the mean, mean nothing: times alone",
                 scene.file);
  else
    for (const auto bounces : options.bounces)
      for (const auto size : options.sizes)
        result.truths.push_back(trace_truth(scene, name, size, bounces, options.truth_spp, cache));

  result.rows = std::move(rows);
  measure_all(result.rows, result.truths, device, scene, options);
  for (const auto& truth : result.truths)
    for (const auto spp : options.path_spps) result.rows.push_back(trace_paths(scene, truth, spp));
  return result;
}

}  // namespace lichtveld::bench
