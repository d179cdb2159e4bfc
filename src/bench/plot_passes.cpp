#include <fmt/format.h>

#include <algorithm>

#include "gnuplot.hpp"
#include "pass_table.hpp"
#include "plots.hpp"

namespace lichtveld::bench {

namespace {

// Milliseconds a PSF and bounce, a line a row: so that all sizes of work stand on one scale.
std::string data_block(const std::vector<Row>& rows) {
  std::string block = "$passes << END\n";
  for (const auto& row : rows) {
    const auto& settings = row.settings;
    block += fmt::format("\"{} {} {}² {}\"", name_of(settings.thesis.abuffer), name_of(settings.thesis.sort),
                         settings.size, settings.psf);
    for (const auto& pass : pass_names())
      block += fmt::format(" {:.6f}", pass_ms(row, pass) / (settings.psf * std::max(1u, row.bounces_used)));
    block += "\n";
  }
  return block + "END\n";
}

std::string plot_command() {
  std::string command = "plot";
  for (std::size_t pass = 0; pass < pass_names().size(); ++pass)
    command += fmt::format("{} $passes using {}:xtic(1) title '{}'", pass == 0 ? "" : ",", pass + 2,
                           pass_names()[pass]);
  return command + "\n";
}

}  // namespace

void plot_passes(const std::vector<Row>& rows, const std::filesystem::path& folder) {
  if (rows.empty()) return;
  draw({.name = "passes",
        .width = 1200,
        .height = 700,
        .script = data_block(rows) +
                  "set title 'What one direction costs in one bounce: each pass, by A-buffer, sort, size "
                  "and directions' noenhanced\n"
                  "set style data histograms\nset style histogram rowstacked\n"
                  "set style fill solid 0.9 border -1\nset boxwidth 0.8\n"
                  "set xtics rotate by 90 right noenhanced font ',9'\nset bmargin 13\n"
                  "set xlabel 'A-buffer, sort, size, directions' offset 0,-8\n"
                  "set ylabel 'milliseconds a direction and bounce'\nset grid ytics\n"
                  "set key top right noenhanced invert\nset yrange [0:*]\n" +
                  plot_command()},
       folder);
}

}  // namespace lichtveld::bench
