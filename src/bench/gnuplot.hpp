// Charts are drawn by gnuplot, which is a program of its own.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lichtveld::bench {

// A picture to draw: gnuplot commands that neither choose a terminal nor an output.
struct Chart {
  std::string name;                // of its files, without an extension
  int width = 1000, height = 700;  // pixels
  std::string script;
  std::map<std::string, std::string> data = {};  // files that the script reads, by name
  std::vector<std::string> formats = {"svg", "png"};
};

// Writes NAME.svg and NAME.png into a folder, whole or not at all. Where gnuplot is not installed or fails, the
// log says so, and that is all: charts are drawn from tables, which are there.
void draw(const Chart& chart, const std::filesystem::path& folder);

// Text in single quotes, as gnuplot wants strings that mean nothing but themselves.
std::string plot_text(const std::string& text);

// "set xtics (...)" at 1 ms, 10 ms, .. 1 h, for an axis in milliseconds; "set ytics" at 1 %, 2 %, 5 %, .. for
// one in per cent.
std::string ticks_of_time();
std::string ticks_of_per_cent();

// Colours that the colour-blind can tell from each other (Okabe and Ito 2008), "#rrggbb"; they repeat.
std::string colour(std::size_t index);

// How so many panels stand beside and below each other.
struct Layout {
  std::size_t columns, rows;
};
Layout layout_of(std::size_t panels);

}  // namespace lichtveld::bench
