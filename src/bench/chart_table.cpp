#include "chart_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lichtveld::bench {

namespace {

// What is nearer by less than this share of the error is not worth more time.
constexpr double worth_it = 0.02;

std::string cell(double value, const char* format = "{:.6g}") {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "";
}

std::string name_of_method(const Row& row) {
  if (row.method == reference_method) return "path tracing";
  if (row.method != thesis_method) return row.method;  // has one way to find layers
  return fmt::format("{}, {} ({})", row.method, name_of(row.settings.thesis.abuffer),
                     name_of(row.settings.thesis.sort));
}

bool sort_is_measured(const Panel& panel, const Row& like, lightfield::Sort sort) {
  return std::any_of(panel.rows.begin(), panel.rows.end(), [&](const Row* row) {
    return row->method == like.method && row->settings.thesis.abuffer == like.settings.thesis.abuffer &&
           row->settings.thesis.sort == sort;
  });
}

// The first of several sorts stands for all where the A-buffer's own was not asked for.
bool on_a_curve(const Row& row, const Panel& panel) {
  if (row.method == reference_method) return true;
  if (row.side) return false;
  const auto own = own_sort(row.settings.thesis.abuffer);
  return row.settings.thesis.sort == own ||
         (!sort_is_measured(panel, row, own) &&
          row.settings.thesis.sort == panel.rows.front()->settings.thesis.sort);
}

}  // namespace

std::string chart_csv(const std::vector<Row>& rows) {
  std::string csv =
      "scene,method,abuffer,sort,size,psf,bounces,ms_median,ms_min,rel_rmse,rel_p99,rel_max,bias,psf_size,"
      "weights,error_estimate,spp\n";
  for (const auto& row : rows) {
    const auto& s = row.settings;
    const bool traced = row.method == reference_method, sorted = row.method == thesis_method;
    csv +=
        fmt::format("{},{},{},{},{},{},{},{:.4f},{:.4f},{},{},{},{},{},{},{},{}\n", csv_cell(row.scene),
                    row.method, sorted ? name_of(s.thesis.abuffer) : "", sorted ? name_of(s.thesis.sort) : "",
                    s.size, traced ? "" : std::to_string(s.psf), name_of_bounces(s), median(row.total_ms),
                    *std::min_element(row.total_ms.begin(), row.total_ms.end()), cell(row.error.rel_rmse),
                    cell(row.error.rel_p99), cell(row.error.rel_max), cell(row.error.bias),
                    traced ? "" : std::to_string(s.raster()), traced ? "" : name_of(s.weights),
                    traced ? "" : cell(row.error_estimate), traced ? std::to_string(row.spp) : "");
  }
  return csv;
}

std::vector<Panel> panels_of(const SweepResult& result) {
  std::vector<Panel> panels;
  for (const auto& truth : result.truths) {
    const auto bounces = !truth.bounces        ? "all bounces"
                         : *truth.bounces == 1 ? "direct light"
                                               : fmt::format("{} bounces", *truth.bounces);
    Panel panel{fmt::format("{}, {}² texels, {}", truth.scene, truth.size, bounces), &truth, {}};
    for (const auto& row : result.rows)
      if (row.scene == truth.scene && row.settings.size == truth.size &&
          row.settings.bounces == truth.bounces && std::isfinite(row.error.rel_rmse))
        panel.rows.push_back(&row);
    if (!panel.rows.empty()) panels.push_back(std::move(panel));
  }
  return panels;
}

std::vector<Curve> curves_of(const Panel& panel) {
  std::vector<Curve> curves;
  for (const auto* row : panel.rows) {
    if (!on_a_curve(*row, panel)) continue;
    const auto name = name_of_method(*row);
    auto curve = std::find_if(curves.begin(), curves.end(), [&](const Curve& c) { return c.name == name; });
    if (curve == curves.end()) curve = curves.insert(curves.end(), {name, {}});
    curve->rows.push_back(row);
  }
  for (auto& curve : curves)
    std::sort(curve.rows.begin(), curve.rows.end(), [](const Row* a, const Row* b) {
      return std::pair(a->settings.psf, a->spp) < std::pair(b->settings.psf, b->spp);
    });
  return curves;
}

std::vector<const Row*> pareto_front(const std::vector<Curve>& curves) {
  std::vector<const Row*> rows, front;
  for (const auto& curve : curves) rows.insert(rows.end(), curve.rows.begin(), curve.rows.end());
  std::sort(rows.begin(), rows.end(),
            [](const Row* a, const Row* b) { return median(a->total_ms) < median(b->total_ms); });
  for (const auto* row : rows)
    if (front.empty() || row->error.rel_rmse < (1 - worth_it) * front.back()->error.rel_rmse)
      front.push_back(row);
  return front;
}

double slope_of(const Curve& curve) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto* row : curve.rows) {
    const double log_psf = std::log(row->settings.psf), log_error = std::log(row->error.rel_rmse);
    n += 1;
    x += log_psf;
    y += log_error;
    xx += log_psf * log_psf;
    xy += log_psf * log_error;
  }
  const double spread = n * xx - x * x;
  return spread > 0 ? (n * xy - x * y) / spread : not_known;
}

std::string chart_text(const SweepResult& result) {
  std::string text;
  for (const auto& panel : panels_of(result)) {
    text +=
        fmt::format("{}: what nothing is both faster and nearer than (the reference's own noise: {:.2f} %)\n",
                    panel.title, 100 * panel.truth->noise);
    for (const auto* row : pareto_front(curves_of(panel))) {
      const auto effort = row->method == reference_method ? fmt::format("--spp {}", row->spp)
                                                          : fmt::format("--psf {}", row->settings.psf);
      text += fmt::format("  {:<31} {:<11} {:>10.1f} ms   rel_rmse {:6.2f} %   bias {:+6.2f} %\n",
                          name_of_method(*row), effort, median(row->total_ms), 100 * row->error.rel_rmse,
                          100 * row->error.bias);
    }
  }
  return text;
}

}  // namespace lichtveld::bench
