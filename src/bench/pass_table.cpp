#include "pass_table.hpp"

#include <fmt/format.h>

#include <map>

namespace lichtveld::bench {

namespace {

using lightfield::ABuffer;
using lightfield::Sort;

std::uint64_t calls_of(const Row& row, const std::string& pass) {
  const auto found = row.passes.front().find(pass);
  return found == row.passes.front().end() ? 0 : found->second.calls;
}

std::string label(const lightfield::Settings& settings) {
  return fmt::format("{},{},{},{}", name_of(settings.thesis.abuffer), name_of(settings.thesis.sort),
                     settings.size, settings.psf);
}

// The row with these settings, or null.
const Row* find(const std::vector<Row>& rows, const Row& like, ABuffer abuffer, Sort sort) {
  for (const auto& row : rows)
    if (row.scene == like.scene && row.settings.size == like.settings.size &&
        row.settings.psf == like.settings.psf && row.settings.bounces == like.settings.bounces &&
        row.settings.thesis.abuffer == abuffer && row.settings.thesis.sort == sort)
      return &row;
  return nullptr;
}

const char* holds(bool it_does) {
  return it_does ? "holds" : "does not hold";
}

}  // namespace

const std::vector<std::string>& pass_names() {
  static const std::vector<std::string> names = {
      "geometry_texture", "emit_radiance", "stencil_routing", "blend", "brdf", "tone_map"};
  return names;
}

double pass_ms(const Row& row, const std::string& pass) {
  std::vector<double> values;
  for (const auto& run : row.passes) {
    const auto found = run.find(pass);
    values.push_back(found == run.end() ? 0 : found->second.gpu_ms);
  }
  return median(values);
}

double total_ms(const Row& row) {
  return median(row.total_ms);
}

std::vector<Row> rows_with_passes(const std::vector<Row>& rows) {
  std::vector<Row> chosen;
  for (const auto& row : rows)
    if (row.method == thesis_method && !row.side) chosen.push_back(row);
  return chosen;
}

std::vector<Row> rows_of_most_sorts(const std::vector<Row>& rows) {
  std::map<std::uint32_t, std::size_t> rows_of_psf;
  for (const auto& row : rows) ++rows_of_psf[row.settings.psf];
  std::uint32_t psf = 0;
  for (const auto& [count, ways] : rows_of_psf)
    if (psf == 0 || ways >= rows_of_psf[psf]) psf = count;
  auto chosen = rows;
  std::erase_if(chosen, [psf](const Row& row) { return row.settings.psf != psf; });
  return chosen;
}

std::string pass_csv(const std::vector<Row>& rows) {
  std::string csv = "scene,method,abuffer,sort,size,psf,bounces,pass,calls,ms_median,ms_a_call\n";
  for (const auto& row : rows)
    for (const auto& pass : pass_names()) {
      const auto calls = calls_of(row, pass);
      const double ms = pass_ms(row, pass);
      csv += fmt::format("{},{},{},{},{},{},{:.4f},{:.6f}\n", csv_cell(row.scene), row.method,
                         label(row.settings), name_of_bounces(row.settings), pass, calls, ms,
                         calls > 0 ? ms / static_cast<double>(calls) : 0.0);
    }
  return csv;
}

std::string pass_text(const std::vector<Row>& rows) {
  std::string text = fmt::format("{:<8} {:<13} {:>5} {:>5}", "abuffer", "sort", "size", "psf");
  for (const auto& pass : pass_names()) text += fmt::format(" {:>16}", pass);
  text += fmt::format(" {:>9}\n", "total ms");
  for (const auto& row : rows) {
    text += fmt::format("{:<8} {:<13} {:>5} {:>5}", name_of(row.settings.thesis.abuffer),
                        name_of(row.settings.thesis.sort), row.settings.size, row.settings.psf);
    for (const auto& pass : pass_names()) text += fmt::format(" {:>16.1f}", pass_ms(row, pass));
    text += fmt::format(" {:>9.0f}\n", total_ms(row));
  }
  return text;
}

std::string findings(const std::vector<Row>& rows) {
  std::string text;
  for (const auto& row : rows) {
    // As the thesis first measured: stencil routing, bitonic sort.
    if (row.settings.thesis.abuffer != ABuffer::stencil || row.settings.thesis.sort != Sort::bitonic) continue;
    const auto where = fmt::format("size {}, {} PSFs", row.settings.size, row.settings.psf);
    double all = 0;
    for (const auto& pass : pass_names()) all += pass_ms(row, pass);
    const double emission = pass_ms(row, "emit_radiance") / all,
                 sorting = pass_ms(row, "stencil_routing") / all;
    text += fmt::format(
        "{}: sorting and multisampled emission dominate: {} ({:.0f} % and {:.0f} % of the passes' time)\n",
        where, holds(emission + sorting > 0.5), 100 * sorting, 100 * emission);
    if (const auto* swap = find(rows, row, ABuffer::stencil, Sort::compare_swap)) {
      const double ratio = pass_ms(row, "stencil_routing") / pass_ms(*swap, "stencil_routing");
      text += fmt::format("{}: compare-and-swap beats bitonic: {} (stencil_routing {:.2f} times faster)\n",
                          where, holds(ratio > 1), ratio);
    }
    const auto* scan = find(rows, row, ABuffer::stencil, Sort::scan);
    const auto* list = find(rows, row, ABuffer::list, Sort::scan);
    if (scan != nullptr && list != nullptr)
      text += fmt::format(
          "{}: the list A-buffer with a scan is {:.2f} times faster than stencil routing with one\n", where,
          total_ms(*scan) / total_ms(*list));
  }
  return text;
}

}  // namespace lichtveld::bench
