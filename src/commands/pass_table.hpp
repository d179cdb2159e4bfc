// The thesis' table: what each pass costs, by A-buffer, sort, size and directions.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "lichtveld/gpu/frame.hpp"
#include "lichtveld/lightfield/settings.hpp"

namespace lichtveld::commands {

// One way to compute a light map, timed several times.
struct PassRow {
  std::string scene;
  lightfield::Settings settings;
  std::vector<gpu::PassTimes> runs;
  std::vector<double> total_ms;  // wall clock of each run
};

// The median over the runs of a pass' GPU time, all its calls together [ms]; 0 if it was not called.
double pass_ms(const PassRow& row, const std::string& pass);
double total_ms(const PassRow& row);  // the median run [ms]

// scene, method, abuffer, sort, size, psf, bounces, pass, calls, ms_median (all calls of a solve), ms_a_call
std::string pass_csv(const std::vector<PassRow>& rows);

// The same as a table to read: a line a row, passes in the order of the algorithm.
std::string pass_text(const std::vector<PassRow>& rows);

// Whether the thesis' findings hold in these rows: that sorting and multisampled emission dominate, and that
// compare-and-swap beats bitonic. One line each, with the figures.
std::string findings(const std::vector<PassRow>& rows);

// The passes in the order of the algorithm.
const std::vector<std::string>& pass_names();

}  // namespace lichtveld::commands
