#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "gnuplot.hpp"
#include "plots.hpp"

namespace lichtveld::bench {

namespace {

std::string name_of_variant(const lightfield::Settings& settings) {
  return fmt::format("{} weights, PSFs of {}² pixels", name_of(settings.weights), settings.raster());
}

// Rows of the A-buffer and sort of the panel's last one (which all variants have), a curve for each variant.
std::vector<Curve> variants_of(const Panel& panel) {
  std::vector<Curve> curves;
  const auto last = std::find_if(panel.rows.rbegin(), panel.rows.rend(),
                                 [](const Row* row) { return row->method == thesis_method; });
  if (last == panel.rows.rend()) return curves;
  for (const auto* row : panel.rows) {
    if (row->method != (*last)->method || row->settings.thesis.abuffer != (*last)->settings.thesis.abuffer ||
        row->settings.thesis.sort != (*last)->settings.thesis.sort)
      continue;
    const auto name = name_of_variant(row->settings);
    auto curve = std::find_if(curves.begin(), curves.end(), [&](const Curve& c) { return c.name == name; });
    if (curve == curves.end()) curve = curves.insert(curves.end(), {name, {}});
    curve->rows.push_back(row);
  }
  return curves;
}

// The fitted line goes through the middle of the points.
double fitted_factor(const Curve& curve, double slope) {
  double sum = 0;
  for (const auto* row : curve.rows)
    sum += std::log(100 * row->error.rel_rmse) - slope * std::log(row->settings.psf);
  return std::exp(sum / static_cast<double>(curve.rows.size()));
}

std::string plot_panel(const Panel& panel, std::size_t number) {
  const auto curves = variants_of(panel);
  std::string blocks, plot = "plot ";
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const auto& curve = curves[i];
    const auto block = fmt::format("$variant{}_{}", number, i);
    blocks += block + " << END\n";
    for (const auto* row : curve.rows)
      blocks += fmt::format("{} {:g}\n", row->settings.psf, 100 * row->error.rel_rmse);
    blocks += "END\n";
    const double slope = slope_of(curve);
    const auto title = std::isfinite(slope) ? fmt::format("{}: slope {:.2f}", curve.name, slope) : curve.name;
    plot += fmt::format("{} using 1:2 with linespoints lw 2 pt {} ps 1.2 lc rgb '{}' title {}, ", block,
                        7 - 2 * (i % 2), colour(i), plot_text(title));
    if (std::isfinite(slope))
      plot += fmt::format("{:g} * x**({:g}) with lines dt 3 lw 1 lc rgb '{}' notitle, ",
                          fitted_factor(curve, slope), slope, colour(i));
  }
  plot += fmt::format("{:g} with lines dt 2 lw 1.5 lc rgb '#888888' title {}", 100 * panel.truth->noise,
                      plot_text(fmt::format("the reference's own noise: {:.2g} %", 100 * panel.truth->noise)));
  return blocks + fmt::format("set title {} noenhanced\n", plot_text(panel.title)) + plot + "\n";
}

}  // namespace

void plot_error_vs_psf(const SweepResult& result, const std::filesystem::path& folder) {
  auto panels = panels_of(result);
  std::erase_if(panels, [](const Panel& panel) { return variants_of(panel).empty(); });
  if (panels.empty()) return;
  std::set<std::uint32_t> counts;
  double low = INFINITY, high = 0;
  for (const auto& panel : panels) {
    low = std::min(low, 100 * panel.truth->noise);
    for (const auto& curve : variants_of(panel))
      for (const auto* row : curve.rows) {
        counts.insert(row->settings.psf);
        low = std::min(low, 100 * row->error.rel_rmse);
        high = std::max(high, 100 * row->error.rel_rmse);
      }
  }
  std::string ticks;
  for (const auto count : counts) ticks += fmt::format("{0}'{1}' {1}", ticks.empty() ? "" : ", ", count);
  const auto [columns, rows] = layout_of(panels.size());
  std::string script = fmt::format(
      "set multiplot layout {},{} title 'What more directions buy (dotted: fitted power of the number of "
      "directions)' font ',14'\n"
      "set logscale xy\nset xtics ({})\n{}set xrange [{:g}:{:g}]\nset yrange [{:g}:{:g}]\n"
      "set grid xtics ytics lt 1 lw 1 lc rgb '#dddddd'\nset xlabel \"directions K\\n \"\n"
      "set ylabel 'rel\\_rmse: RMS error / mean irradiance'\nset key below left Left reverse maxcols 1 "
      "noenhanced\n"
      "set border 3\nset tics nomirror\n",
      rows, columns, ticks, ticks_of_per_cent(), *counts.begin() * 0.7, *counts.rbegin() * 1.4, low * 0.7,
      high * 1.4);
  for (std::size_t i = 0; i < panels.size(); ++i) script += plot_panel(panels[i], i);
  draw({.name = "error_vs_psf",
        .width = static_cast<int>(columns) * 700 + (columns == 1 ? 200 : 0),
        .height = static_cast<int>(rows) * 660,
        .script = script + "unset multiplot\n"},
       folder);
}

}  // namespace lichtveld::bench
