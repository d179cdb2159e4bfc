// The thesis' table: what each pass costs, by A-buffer, sort, size and directions.
#pragma once

#include <string>
#include <vector>

#include "row.hpp"

namespace lichtveld::bench {

// The median over the runs of a pass' GPU time, all its calls together [ms]; 0 if it was not called.
double pass_ms(const Row& row, const std::string& pass);
double total_ms(const Row& row);  // the median run [ms]

// The rows of methods on the device, without those that vary weights or the PSFs' pixels.
std::vector<Row> rows_with_passes(const std::vector<Row>& rows);

// Of those, the rows with that number of directions at which most ways to sort were timed, the largest if there
// are several: what a direction costs does not depend on how many there are.
std::vector<Row> rows_of_most_sorts(const std::vector<Row>& rows);

// scene, method, abuffer, sort, size, psf, bounces, pass, calls, ms_median (all calls of a solve), ms_a_call
std::string pass_csv(const std::vector<Row>& rows);

// The same as a table to read: a line a row, passes in the order of the algorithm.
std::string pass_text(const std::vector<Row>& rows);

// Whether the thesis' findings hold in these rows: that sorting and multisampled emission dominate, and that
// compare-and-swap beats bitonic. One line each, with the figures.
std::string findings(const std::vector<Row>& rows);

// The passes in the order of the algorithm.
const std::vector<std::string>& pass_names();

}  // namespace lichtveld::bench
