#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "gnuplot.hpp"
#include "plots.hpp"

namespace lichtveld::bench {

namespace {

using Map = std::vector<glm::vec4>;

// The scale of the errors [% of the truth's mean]: below the first nobody sees them, the second is all of the
// light.
constexpr double least_error = 0.3, most_error = 100;

double mean_of(const Map& truth) {
  double sum = 0, values = 0;
  for (const auto& texel : truth)
    if (texel.a > 0) {
      sum += double{texel.r} + texel.g + texel.b;
      values += 3;
    }
  return sum / values;
}

// E as the eye would like it: a mean of 1 becomes a middle grey, what is 4 times as bright white; sRGB's curve.
std::string shown(const Map& map, const Map& truth, double mean) {
  std::string bytes;
  bytes.reserve(map.size() * 3);
  for (std::size_t texel = 0; texel < map.size(); ++texel)
    for (int channel = 0; channel < 3; ++channel) {
      const double light = std::clamp(map[texel][channel] / (4 * mean), 0.0, 1.0);
      const double curved = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
      bytes.push_back(static_cast<char>(truth[texel].a > 0 ? std::lround(255 * curved) : 255));
    }
  return bytes;
}

// 32-bit floats; NaN, which is not drawn, outside the charts.
template <typename ErrorOf>
std::string errors(const Map& truth, double mean, ErrorOf error_of) {
  std::string bytes;
  bytes.reserve(truth.size() * sizeof(float));
  for (std::size_t texel = 0; texel < truth.size(); ++texel) {
    const double share = 100 * error_of(texel) / mean;
    const auto value =
        truth[texel].a > 0 ? static_cast<float>(std::clamp(share, least_error, most_error)) : NAN;
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  return bytes;
}

struct Column {
  std::string title, below, light, error;
};

Column column_of_truth(const Truth& truth, double mean) {
  const auto& light = truth.light;
  return {fmt::format("reference, {} paths a texel", truth.spp),
          fmt::format("its own noise: {:.2g} %", 100 * truth.noise), shown(light.texels, light.texels, mean),
          errors(light.texels, mean, [&](std::size_t texel) { return light.standard_error[texel]; })};
}

Column column_of(const Row& row, const Truth& truth, double mean) {
  const auto& exact = truth.light.texels;
  const bool equal = row.settings.weights == lightfield::Weights::equal;
  const auto difference = [&](std::size_t texel) {
    const glm::vec4 d = glm::abs(row.map[texel] - exact[texel]);
    return double{d.r + d.g + d.b} / 3;
  };
  const double ms = median(row.total_ms);
  return {fmt::format("{}, {} directions{}", row.method, row.settings.psf, equal ? ", equal weights" : ""),
          fmt::format("rel_rmse {:.1f} %, {}", 100 * row.error.rel_rmse,
                      ms < 1000 ? fmt::format("{:.0f} ms", ms) : fmt::format("{:.1f} s", ms / 1000)),
          shown(row.map, exact, mean), errors(exact, mean, difference)};
}

// Few, middle and most directions, and most with equal weights.
std::vector<const Row*> rows_to_show(const Panel& panel) {
  std::vector<const Row*> usual, equal, chosen;
  for (const auto* row : panel.rows) {
    if (row->map.empty()) continue;
    if (!row->side) usual.push_back(row);
    if (row->side && row->settings.weights == lightfield::Weights::equal) equal.push_back(row);
  }
  const auto by_psf = [](const Row* a, const Row* b) { return a->settings.psf < b->settings.psf; };
  std::sort(usual.begin(), usual.end(), by_psf);
  std::sort(equal.begin(), equal.end(), by_psf);
  if (!usual.empty()) chosen.push_back(usual.front());
  if (usual.size() > 2) chosen.push_back(usual[usual.size() / 2]);
  if (usual.size() > 1) chosen.push_back(usual.back());
  if (!equal.empty()) chosen.push_back(equal.back());
  return chosen;
}

std::string cell(std::size_t column, std::size_t columns, bool top) {
  const double width = 0.92 / static_cast<double>(columns), left = 0.005 + width * static_cast<double>(column);
  return fmt::format(
      "set lmargin at screen {:g}\nset rmargin at screen {:g}\nset bmargin at screen {:g}\nset tmargin at "
      "screen "
      "{:g}\n",
      left, left + width - 0.008, top ? 0.50 : 0.05, top ? 0.91 : 0.46);
}

}  // namespace

void plot_error_maps(const SweepResult& result, const std::string& scene, const std::filesystem::path& folder) {
  for (const auto& panel : panels_of(result)) {
    const auto rows = rows_to_show(panel);
    if (panel.truth->scene != scene || rows.empty()) continue;
    const double mean = mean_of(panel.truth->light.texels);
    std::vector<Column> columns = {column_of_truth(*panel.truth, mean)};
    for (const auto* row : rows) columns.push_back(column_of(*row, *panel.truth, mean));

    Chart chart{
        .name = "error_maps_" + scene,
        .width = static_cast<int>(columns.size()) * 330 + 110,
        .height = 780,
        .script = fmt::format(
            "set multiplot title {} font ',14' noenhanced\n"
            "unset key\nunset border\nunset tics\nset size ratio -1\n"
            "set palette defined (0 '#000022', 0.25 '#3b1a7a', 0.5 '#b5367a', 0.75 '#fb8761', 1 '#fcfdbf')\n"
            "set logscale cb\nset cbrange [{}:{}]\nset cbtics ('0.3 %%' 0.3, '1 %%' 1, '3 %%' 3, '10 %%' 10, "
            "'30 %%' "
            "30, '100 %%' 100)\nunset colorbox\n",
            plot_text(panel.title + ": irradiance (top) and how far it is from the reference (bottom)"),
            least_error, most_error),
        .formats = {"png"}};
    const auto image = fmt::format("binary array=({0},{0}) flipy format=", panel.truth->size);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto light = fmt::format("light{}", i), error = fmt::format("error{}", i);
      chart.data[light] = columns[i].light;
      chart.data[error] = columns[i].error;
      chart.script += cell(i, columns.size(), true) + "unset xlabel\n" +
                      fmt::format("set title {} noenhanced\nplot '{}' {}'%uchar' with rgbimage\n",
                                  plot_text(columns[i].title), light, image);
      if (i + 1 == columns.size())
        chart.script +=
            "set colorbox user origin 0.93,0.07 size 0.012,0.37\n"
            "set cblabel '|E - E_{ref}| / mean E_{ref}' offset 1.5,0\n";
      chart.script += cell(i, columns.size(), false) +
                      fmt::format("unset title\nset xlabel {} noenhanced\nplot '{}' {}'%float' with image\n",
                                  plot_text(columns[i].below), error, image);
    }
    chart.script += "unset multiplot\n";
    draw(chart, folder);
  }
}

}  // namespace lichtveld::bench
