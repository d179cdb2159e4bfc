// Charts of bench, drawn by gnuplot into a folder. Each returns false, and says so in the log, where gnuplot is
// not installed or fails.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "chart_table.hpp"

namespace lichtveld::bench {

// passes.svg, passes.png: stacked bars, a bar a row, of the milliseconds that one direction costs in each pass.
void plot_passes(const std::vector<Row>& rows, const std::filesystem::path& folder);

// chart.svg, chart.png: error against time, a line a method, the Pareto front marked.
void plot_chart(const SweepResult& result, const std::filesystem::path& folder);

// error_vs_psf.svg, .png: error against directions, with either weights and every resolution of PSFs.
void plot_error_vs_psf(const SweepResult& result, const std::filesystem::path& folder);

// error_maps_SCENE.png: the light map of the truth and of some rows, and their differences from it, in colours.
void plot_error_maps(const SweepResult& result, const std::string& scene, const std::filesystem::path& folder);

}  // namespace lichtveld::bench
