#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gnuplot.hpp"
#include "plots.hpp"

namespace lichtveld::bench {

namespace {

// One scale for all panels, so that they can be compared.
struct Range {
  double low = INFINITY, high = 0;
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  std::string text(double below, double above) const {
    return fmt::format("[{:g}:{:g}]", low * below, high * above);
  }
};

std::string data_block(const std::string& name, const std::vector<const Row*>& rows) {
  std::string block = "$" + name + " << END\n";
  for (const auto* row : rows) {
    const auto effort =
        row->method == reference_method ? fmt::format("{} spp", row->spp) : std::to_string(row->settings.psf);
    block += fmt::format("{:g} {:g} \"{}\"\n", median(row->total_ms), 100 * row->error.rel_rmse, effort);
  }
  return block + "END\n";
}

std::string plot_panel(const Panel& panel, std::size_t number) {
  const auto curves = curves_of(panel);
  const auto front = fmt::format("front{}", number);
  std::string blocks = data_block(front, pareto_front(curves));
  std::string plot = fmt::format(
      "plot ${} using 1:2 with linespoints lw 14 pt 7 ps 2.6 lc rgb '#ffe9a8' title 'Pareto front: nothing "
      "else is "
      "both faster and nearer'",
      front);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const bool traced = curves[i].rows.front()->method == reference_method;
    const auto block = fmt::format("curve{}_{}", number, i);
    const auto ink = traced ? "#444444" : colour(i);
    blocks += data_block(block, curves[i].rows);
    plot += fmt::format(
        ", ${0} using 1:2 with linespoints lw 2 pt {1} ps 1.1 lc rgb '{2}' title {3}"
        ", ${0} using 1:2:3 with labels offset {4} font ',10' tc rgb '{2}' notitle",
        block, traced ? 9 : 7 - 2 * (i % 2), ink, plot_text(curves[i].name),
        i == 0   ? "1.2,0.7 left"
        : traced ? "0.3,0.9 left"
                 : "-1.2,-0.7 right");
  }
  plot += fmt::format(", {:g} with lines dt 2 lw 1.5 lc rgb '#888888' title {}", 100 * panel.truth->noise,
                      plot_text(fmt::format("the reference's own noise ({} paths a texel): {:.2g} %",
                                            panel.truth->spp, 100 * panel.truth->noise)));
  return blocks + fmt::format("set title {} noenhanced\n", plot_text(panel.title)) + plot + "\n";
}

}  // namespace

void plot_chart(const SweepResult& result, const std::filesystem::path& folder) {
  const auto panels = panels_of(result);
  if (panels.empty()) return;
  Range time, error;
  for (const auto& panel : panels) {
    error.take(100 * panel.truth->noise);
    for (const auto& curve : curves_of(panel))
      for (const auto* row : curve.rows) {
        time.take(median(row->total_ms));
        error.take(100 * row->error.rel_rmse);
      }
  }
  const auto [columns, rows] = layout_of(panels.size());
  std::string script = fmt::format(
      "set multiplot layout {},{} title 'What a light map costs and how near it comes (lower left is better; "
      "numbers: "
      "directions)' font ',14'\n"
      "set logscale xy\n{}{}"
      "set xrange {}\nset yrange {}\nset grid xtics ytics lt 1 lw 1 lc rgb '#dddddd'\n"
      "set xlabel \"time of one light map\\n \"\nset ylabel 'rel\\_rmse: RMS error / mean irradiance'\n"
      "set key below left Left reverse maxcols 1 noenhanced\nset border 3\nset tics nomirror\n",
      rows, columns, ticks_of_time(), ticks_of_per_cent(), time.text(0.5, 2.5), error.text(0.7, 1.4));
  for (std::size_t i = 0; i < panels.size(); ++i) script += plot_panel(panels[i], i);
  draw({.name = "chart",
        .width = static_cast<int>(columns) * 760 + (columns == 1 ? 200 : 0),
        .height = static_cast<int>(rows) * 720,
        .script = script + "unset multiplot\n"},
       folder);
}

}  // namespace lichtveld::bench
