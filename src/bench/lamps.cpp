#include "lamps.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>

#include "gnuplot.hpp"
#include "lichtveld/files/output.hpp"
#include "lichtveld/lightfield/engine.hpp"
#include "scale_room.hpp"
#include "scratch.hpp"

namespace lichtveld::bench {

namespace {

constexpr std::array shares_of_the_ceiling = {1.0, 0.3, 0.1, 0.03, 0.01, 0.001, 0.0001};
constexpr std::uint32_t triangles_of_the_floor = 200;
constexpr const char* before_share = "lamp_";

// Each engine as it is by default: the thesis sees lamps by its directions, the others know them.
std::vector<Row> rows_of_room(const std::string& scene, const SweepOptions& options) {
  std::vector<Row> rows;
  for (const auto& engine : lightfield::engines())
    rows.push_back(
        {.scene = scene,
         .method = engine.name,
         .settings = curve_settings(lightfield::ABuffer::list, options.sizes.back(), engine.psf, options)});
  return rows;
}

std::string name_of(const Row& row) {
  return fmt::format("{}, {} directions", row.method, row.settings.psf);
}

// What a room's name says [%].
double lamp_share(const std::string& scene) {
  return std::strtod(scene.c_str() + std::string(before_share).size(), nullptr);
}

}  // namespace

SweepResult compare_lamps(const gpu::Device& device, const SweepOptions& options, const ReferenceCache& cache) {
  SweepResult result;
  const Scratch scratch;
  const auto file = scratch.path() / "lamps.glb";  // references are kept by its name
  for (const double share : shares_of_the_ceiling) {
    const auto name = fmt::format("{}{:g}_percent", before_share, 100 * share);
    files::write_text(file, scale_room(triangles_of_the_floor, static_cast<float>(std::sqrt(share))));
    const auto scene = scene::load(file.string());
    SweepOptions one = options;
    one.sizes = {options.sizes.back()};
    one.bounces = {options.bounces.front()};
    one.path_spps.clear();
    append(result, sweep(device, scene, name, rows_of_room(name, one), one, cache));
  }
  return result;
}

void plot_lamps(const SweepResult& result, const std::filesystem::path& folder) {
  std::vector<std::string> names;  // in the order of the rows
  std::map<std::string, std::string> points;
  for (const auto& row : result.rows) {
    const auto name = name_of(row);
    if (!points.contains(name)) names.push_back(name);
    points[name] += fmt::format("{:g} {:g}\n", lamp_share(row.scene), 100 * row.error.rel_rmse);
  }
  std::string noise, blocks, plot;
  for (const auto& truth : result.truths)
    noise += fmt::format("{:g} {:g}\n", lamp_share(truth.scene), 100 * truth.noise);
  for (std::size_t i = 0; i < names.size(); ++i) {
    blocks += fmt::format("$method{} << END\n{}END\n", i, points[names[i]]);
    plot += fmt::format("$method{} using 1:2 with linespoints lw 2 pt 7 ps 1.1 lc rgb '{}' title {}, ", i,
                        colour(i), plot_text(names[i]));
  }
  draw(
      {.name = "lamps",
       .width = 900,
       .height = 720,
       .script = fmt::format(
           "{}$noise << END\n{}END\n"
           "set title 'How near a light map comes by how large the lamp is ({} texels a side)' font ',14'\n"
           "set logscale xy\nset xrange [150:{:g}] reverse\n{}"
           "set xtics ('the whole ceiling' 100, '10 %%' 10, '1 %%' 1, '0.1 %%' 0.1, '0.01 %%: a candle' 0.01)\n"
           "set grid xtics ytics lt 1 lw 1 lc rgb '#dddddd'\nset xlabel 'lamp, as a share of the ceiling'\n"
           "set ylabel 'rel\\_rmse: RMS error / mean irradiance'\n"
           "set key below left Left reverse maxcols 1 noenhanced\nset border 3\nset tics nomirror\n"
           "plot {}$noise using 1:2 with lines dt 2 lw 1.5 lc rgb '#888888' title {}\n",
           blocks, noise, result.truths.front().size, 100 * shares_of_the_ceiling.back() / 2,
           ticks_of_per_cent(), plot,
           plot_text(fmt::format("the reference's own noise, {} paths a texel", result.truths.front().spp)))},
      folder);
}

}  // namespace lichtveld::bench
