// The table of speed against error, and what charts take from it.
#pragma once

#include <string>
#include <vector>

#include "row.hpp"
#include "sweep.hpp"

namespace lichtveld::bench {

// scene, method, abuffer, sort, size, psf, bounces, ms_median, ms_min, rel_rmse, rel_p99, rel_max, bias,
// psf_size, weights, error_estimate, spp. A cell is empty where it does not apply or is not known.
std::string chart_csv(const std::vector<Row>& rows);

// Rows that can be compared fairly: one scene, one size, the same bounces.
struct Panel {
  std::string title;
  const Truth* truth;
  std::vector<const Row*> rows;
};

// A panel for each truth that some row has an error against; by scene, then bounces, then size.
std::vector<Panel> panels_of(const SweepResult& result);

// A line of a chart: rows that differ in their PSFs alone (in their paths, for the reference), ascending.
struct Curve {
  std::string name;
  std::vector<const Row*> rows;
};

// One for each method and A-buffer, with the sort that own_sort names where it was measured, and one of the
// reference.
std::vector<Curve> curves_of(const Panel& panel);

// The rows of these curves that no other is both faster than and as near as (give or take 2 % of the error), by
// time.
std::vector<const Row*> pareto_front(const std::vector<Curve>& curves);

// The exponent s of error = c * psf^s, by least squares on logarithms; NaN for fewer than two rows.
double slope_of(const Curve& curve);

// The Pareto front of each panel, and the truth's noise, to read.
std::string chart_text(const SweepResult& result);

}  // namespace lichtveld::bench
