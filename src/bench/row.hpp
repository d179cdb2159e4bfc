// One way to compute a light map, timed and compared with the truth: a line of bench's tables.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <vector>

#include "lichtveld/gpu/times.hpp"
#include "lichtveld/lightfield/settings.hpp"
#include "lichtveld/reference/error.hpp"

namespace lichtveld::bench {

// Path tracing as a method, and the engines that tables and charts know by name.
inline constexpr const char* reference_method = "reference";
inline constexpr const char* thesis_method = "thesis";
inline constexpr const char* links_method = "links";
inline constexpr const char* rays_method = "rays";

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

struct Row {
  std::string scene;                        // the file's stem
  std::string method;                       // an engine's name, or reference_method
  lightfield::Settings settings;            // of the reference: size and bounces alone
  std::uint32_t spp = 0;                    // of the reference: paths a texel
  std::vector<double> total_ms = {};        // wall clock of each run, at least one once measured
  std::vector<gpu::PassTimes> passes = {};  // of each run
  std::uint32_t bounces_used = 0;
  bool side = false;  // varies what the other rows have alike: weights, or the PSFs' pixels
  reference::Error error = {not_known, not_known, not_known, not_known};  // of the last run
  double error_estimate = not_known;  // what the method itself believes of rel_rmse
  std::vector<glm::vec4> map = {};    // E of the last run, of the rows that error maps show
};

// The middle value of a list that is not empty, or the mean of the two in the middle.
double median(std::vector<double> values);

// The value that a share of the list does not exceed: 0.95 for the 95th percentile.
double percentile(std::vector<double> values, double share);

// Text as a cell of a .csv file: in quotes if it would not be one otherwise.
std::string csv_cell(const std::string& text);

// "auto", or the number of bounces.
std::string name_of_bounces(const lightfield::Settings& settings);

// The sort that an A-buffer's curve in the charts has: the thesis' last choice for its stencil routing, a scan
// for the list.
lightfield::Sort own_sort(lightfield::ABuffer abuffer);

}  // namespace lichtveld::bench
