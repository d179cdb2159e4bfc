#include "row.hpp"

#include <algorithm>
#include <cmath>

namespace lichtveld::bench {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size() - 1)))];
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return quoted + "\"";
}

std::string name_of_bounces(const lightfield::Settings& settings) {
  return settings.bounces ? std::to_string(*settings.bounces) : "auto";
}

lightfield::Sort own_sort(lightfield::ABuffer abuffer) {
  return abuffer == lightfield::ABuffer::stencil ? lightfield::Sort::compare_swap : lightfield::Sort::scan;
}

}  // namespace lichtveld::bench
