// Charts of bench, drawn by gnuplot.
#pragma once

#include <filesystem>
#include <vector>

#include "pass_table.hpp"

namespace lichtveld::commands {

// Stacked bars, a bar a row, of the milliseconds that one direction costs in each pass: passes.svg and
// passes.png in `folder`. Returns false, and says so in the log, where gnuplot is not installed.
bool plot_passes(const std::vector<PassRow>& rows, const std::filesystem::path& folder);

}  // namespace lichtveld::commands
