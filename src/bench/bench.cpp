#include "lichtveld/bench/bench.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "lamps.hpp"
#include "lichtveld/files/output.hpp"
#include "lichtveld/scene/atlas.hpp"
#include "pass_table.hpp"
#include "plots.hpp"
#include "scale.hpp"
#include "updates.hpp"

namespace lichtveld::bench {

namespace {

namespace fs = std::filesystem;

// A truth whose noise is more than this share of an error tells little about it.
constexpr double most_noise = 0.5;
// At the walk's end fewer paths do: one error a row is read there, no trend.
constexpr std::uint32_t fewer_paths_after_walks = 4;

void check_all(const Options& options) {
  rows_of("", options.sweep);
  for (const auto bounces : options.sweep.bounces)
    for (const auto spp : options.sweep.path_spps) reference::check({.bounces = bounces, .spp = spp});
  reference::check({.spp = options.sweep.truth_spp});
}

UpdateOptions walks_of(const Options& options) {
  const auto& sweep = options.sweep;
  UpdateOptions walks{.steps = options.updates,
                      .settings = {},
                      .truth_spp = std::max(2u, sweep.truth_spp / fewer_paths_after_walks)};
  for (const auto size : sweep.sizes)
    for (const auto psf : options.update_psfs) {
      walks.settings.push_back(curve_settings(sweep.abuffers.back(), size, psf, sweep));
      walks.settings.back().bounces.reset();  // players see the light of all bounces
    }
  return walks;
}

void warn_of_noise(const SweepResult& result) {
  for (const auto& panel : panels_of(result)) {
    double least = INFINITY;
    for (const auto* row : panel.rows) least = std::min(least, row->error.rel_rmse);
    if (panel.truth->noise > most_noise * least)
      spdlog::warn(
          "{}: the reference's own noise, {:.2g} %, is part of the errors down to {:.2g} %; raise --spp",
          panel.title, 100 * panel.truth->noise, 100 * least);
  }
}

void write_charts(const SweepResult& result, const fs::path& out) {
  const auto passes = rows_with_passes(result.rows);
  files::write_text(out / "chart.csv", chart_csv(result.rows));
  files::write_text(out / "passes.csv", pass_csv(passes));
  const auto table = rows_of_most_sorts(passes);
  std::printf(
      "\nMilliseconds of all calls of a pass in one solve, medians\n\n%s\nThe thesis' findings here:\n%s\n%s",
      pass_text(table).c_str(), findings(table).c_str(), chart_text(result).c_str());
  std::fflush(stdout);
  warn_of_noise(result);
  plot_passes(table, out);
  plot_chart(result, out);
  plot_error_vs_psf(result, out);
}

}  // namespace

Bench::Bench(Options options) : options_(std::move(options)) {
  check_all(options_);
  for (const auto& file : options_.own_rooms() ? std::vector<std::string>() : options_.scenes) {
    scenes_.push_back({fs::path(file).stem().string(), scene::load(file)});
    for (const auto size : options_.sweep.sizes) scene::check_atlas(scenes_.back().scene, size);
  }
  files::make_folder(options_.out);
}

void Bench::run(const gpu::Device& device) const {
  const fs::path out = options_.out;
  const ReferenceCache cache(options_.reference_cache);
  std::printf("%s\n", device.summary().name.c_str());
  if (options_.scale) {
    const auto rows = time_scale(device, options_.sweep.sizes.back());
    files::write_text(out / "scale.csv", scale_csv(rows));
    std::printf("%s", scale_text(rows).c_str());
    return;
  }

  if (options_.lamps) {
    const auto result = compare_lamps(device, options_.sweep, cache);
    files::write_text(out / "lamps.csv", chart_csv(result.rows));
    warn_of_noise(result);
    plot_lamps(result, out);
    plot_error_maps(result, result.rows.back().scene, out);
    return;
  }

  SweepResult result;
  for (const auto& [name, scene] : scenes_)
    append(result, sweep(device, scene, name, rows_of(name, options_.sweep), options_.sweep, cache));
  write_charts(result, out);
  for (const auto& [name, scene] : scenes_) plot_error_maps(result, name, out);

  std::vector<UpdateRow> updates;
  if (options_.updates > 0)
    for (const auto& [name, scene] : scenes_) {
      auto more = time_updates(device, scene, name, walks_of(options_), cache);
      std::move(more.begin(), more.end(), std::back_inserter(updates));
    }
  if (!updates.empty()) {
    files::write_text(out / "updates.csv", updates_csv(updates));
    files::write_text(out / "choices.csv", choices_csv(updates));
    std::printf("\nA light map after each step of the first movable body:\n%s", updates_text(updates).c_str());
  }
  spdlog::info("{}: tables (.csv) and charts (.svg, .png)", out.string());
}

}  // namespace lichtveld::bench
