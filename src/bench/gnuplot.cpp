#include "gnuplot.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "lichtveld/files/output.hpp"
#include "scratch.hpp"

namespace lichtveld::bench {

namespace {

namespace fs = std::filesystem;

// For a shell.
std::string escaped(const std::string& text) {
  std::string out = "'";
  for (const char letter : text) out += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return out + "'";
}

std::string terminal(const std::string& format, const Chart& chart) {
  if (format == "svg")
    return fmt::format("set terminal svg size {},{} dynamic background 'white' font 'sans-serif,13'\n",
                       chart.width, chart.height);
  return fmt::format("set terminal pngcairo size {},{} font 'sans-serif,11'\n", chart.width, chart.height);
}

std::string contents_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

// Runs gnuplot in the scratch folder, and returns the picture's bytes.
std::string drawn(const std::string& format, const Chart& chart, const Scratch& scratch) {
  const auto picture = chart.name + "." + format, script = picture + ".gnuplot";
  files::write_text(scratch.path() / script, terminal(format, chart) + "set output " + plot_text(picture) +
                                                 "\n" + "set encoding utf8\n" + chart.script +
                                                 "unset output\n");
  const auto command =
      fmt::format("cd {} && gnuplot {} 2>complaints", escaped(scratch.path().string()), escaped(script));
  if (std::system(command.c_str()) == 0) return contents_of(scratch.path() / picture);
  throw std::runtime_error("gnuplot failed: " + contents_of(scratch.path() / "complaints"));
}

}  // namespace

void draw(const Chart& chart, const fs::path& folder) {
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) {
    spdlog::warn("no {}: gnuplot is not installed; install gnuplot-nox (the tables are written)", chart.name);
    return;
  }
  try {
    // Files, not a pipe: writing to a gnuplot that is not there would end us.
    const Scratch scratch;
    for (const auto& [name, bytes] : chart.data) files::write_text(scratch.path() / name, bytes);
    for (const auto& format : chart.formats)
      files::write_text(folder / (chart.name + "." + format), drawn(format, chart, scratch));
  } catch (const std::exception& error) {
    spdlog::warn("no {}: {} (the tables are written)", chart.name, error.what());
  }
}

std::string plot_text(const std::string& text) {
  std::string out = "'";
  for (const char letter : text) {
    if (letter == '\'') out += letter;  // twice is once
    out += letter == '\n' || letter == '\r' ? ' ' : letter;
  }
  return out + "'";
}

std::string ticks_of_time() {
  return "set xtics ('0.1 ms' 0.1, '1 ms' 1, '10 ms' 10, '100 ms' 100, '1 s' 1e3, '10 s' 1e4, '100 s' 1e5, "
         "'1000 s' 1e6)\n"
         "set for [d=-1:5] for [m=2:9] xtics add ('' m*10**d 1)\n";
}

std::string ticks_of_per_cent() {
  std::string ticks = "set ytics (";
  for (const double decade : {0.01, 0.1, 1.0, 10.0, 100.0})
    for (const int step : {1, 2, 5}) ticks += fmt::format("'{0:g} %%' {0:g}, ", step * decade);
  return ticks + "'1000 %%' 1000)\n";
}

std::string colour(std::size_t index) {
  static const std::array<std::string, 6> colours = {"#d55e00", "#0072b2", "#009e73",
                                                     "#cc79a7", "#e69f00", "#56b4e9"};
  return colours[index % colours.size()];
}

Layout layout_of(std::size_t panels) {
  const std::size_t columns = panels > 1 ? 2 : 1;
  return {columns, (panels + columns - 1) / columns};
}

}  // namespace lichtveld::bench
