#include "plot.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>

#include "options.hpp"

namespace lichtveld::commands {

namespace {

// Milliseconds a PSF and bounce, a line a row: so that all sizes of work stand on one scale.
std::string data_block(const std::vector<PassRow>& rows) {
  std::string block = "$passes << END\n";
  for (const auto& row : rows) {
    const auto& settings = row.settings;
    block += fmt::format("\"{} {} {}² {}\"", name_of(settings.abuffer), name_of(settings.sort), settings.size,
                         settings.psf);
    for (const auto& pass : pass_names())
      block += fmt::format(" {:.6f}", pass_ms(row, pass) / (settings.psf * *settings.bounces));
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

bool plot_passes(const std::vector<PassRow>& rows, const std::filesystem::path& folder) {
  FILE* gnuplot = popen("gnuplot 2>/dev/null", "w");
  if (gnuplot == nullptr) return false;
  const std::string settings =
      "set encoding utf8\n"
      "set title 'What one PSF costs in one bounce: each pass, by A-buffer, sort, size and directions' "
      "noenhanced\n"
      "set style data histograms\nset style histogram rowstacked\nset style fill solid 0.9 border -1\nset "
      "boxwidth 0.8\n"
      "set xtics rotate by 90 right noenhanced font ',9'\nset bmargin 13\nset xlabel 'A-buffer, sort, size, "
      "PSFs' offset 0,-8\nset ylabel 'milliseconds a PSF and bounce'\nset grid "
      "ytics\n"
      "set key top right noenhanced invert\nset yrange [0:*]\n";
  std::string script = data_block(rows) + settings;
  for (const auto& [terminal, file] : {std::pair{"svg size 1200,700 dynamic background 'white'", "passes.svg"},
                                       std::pair{"pngcairo size 1200,700", "passes.png"}})
    script += fmt::format("set terminal {}\nset output '{}'\n{}unset output\n", terminal,
                          (folder / file).string(), plot_command());
  std::fwrite(script.data(), 1, script.size(), gnuplot);
  if (pclose(gnuplot) == 0) return true;
  spdlog::warn("no charts: gnuplot is not installed or failed; install gnuplot-nox (the tables are written)");
  return false;
}

}  // namespace lichtveld::commands
