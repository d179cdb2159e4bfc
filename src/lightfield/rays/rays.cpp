#include "rays/rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/buried.hpp"
#include "core/convergence.hpp"
#include "core/memory.hpp"
#include "core/parallel.hpp"
#include "lichtveld/progress/progress.hpp"

namespace lichtveld::lightfield {

namespace {

constexpr std::uint32_t rows_of_a_task = 1024;

std::uint32_t side_of(std::uint32_t sets) {
  return sets == 16 ? 4 : sets == 4 ? 2 : 1;
}

// Of soft lamps' samples: as many as of directions in each of four blocks that are beside each other.
std::uint32_t sample_set_count(const Settings& settings) {
  return settings.rays.sets > 1 ? 4 * settings.rays.sets : 1;
}

std::vector<std::uint32_t> sample_sets(const Rows& rows, const Settings& settings) {
  std::vector<std::uint32_t> sets;
  const std::uint32_t side = side_of(settings.rays.sets);
  for (std::uint32_t row = 0; row < rows.count(); ++row) {
    const std::uint32_t atlas = rows[row].atlas, x = atlas % settings.size / side,
                        y = atlas / settings.size / side;
    sets.push_back(settings.rays.sets > 1 ? 4 * rows.set(row) + 2 * (y % 2) + x % 2 : 0);
  }
  return sets;
}

}  // namespace

Rays::Rays(const gpu::Device& device, const scene::Scene& scene, const Settings& settings)
    : LightField(scene, settings.direct.value_or(Direct::exact)),
      device_(device),
      begun_(device.times().so_far()),
      scene_(scene),
      settings_(settings),
      records_(device.times().time("texel_records", [&] { return TexelRecords(scene, settings.size); })),
      index_(device.times().time("ray_index", [&] { return std::make_unique<scene::RayIndex>(scene); })),
      rows_(device.times().time("rows", [&] { return Rows(scene, records_, side_of(settings.rays.sets)); })),
      memory_(device.ledger(), "lightfield/rays", bytes()),
      sets_(settings.psf / 2, settings.rays.sets, settings.seed),
      links_(*index_, scene, rows_, sets_, device.times().time("buried", [&] { return hidden(); })),
      filter_(rows_, links_, side_of(settings.rays.sets)),
      sample_sets_(sample_sets(rows_, settings)),
      lamps_(*index_, scene, rows_.all(), settings.size, {sample_set_count(settings), sample_sets_}),
      gather_(rows_, links_, settings.direct.value_or(Direct::exact)),
      averages_(rows_.count()),
      irradiance_(std::size_t{settings.size} * settings.size, glm::vec4(0)) {}

std::vector<char> Rays::hidden() const {
  return settings_.buried == Buried::lit ? std::vector<char>(rows_.count())
                                         : find_buried(*index_, scene_, rows_.all());
}

// Of what is kept a row. Throws std::runtime_error if it is too much.
std::uint64_t Rays::bytes() const {
  const std::uint64_t lamps = find_area_lamps(scene_, LampLight::most_lamps).size();
  const std::uint64_t a_row =
      settings_.psf / 2 * RayLinks::bytes_a_ray + BlockFilter::bytes_a_row + lamps * LampLight::bytes_a_lamp;
  const auto all = rows_.count() * a_row;
  require_memory("what " + std::to_string(rows_.count()) + " places see in " +
                     std::to_string(settings_.psf / 2) + " directions each, and their " +
                     std::to_string(lamps) + " lamps,",
                 all, settings_.memory, "try a smaller --size or --psf, or a larger --memory");
  return all;
}

bool Rays::compute(Light before, const Moves& moves, const Enough& enough, Solution& solution) {
  auto& times = device_.times();
  const bool changed = before == Light::unknown || before == Light::moved;
  // For the map after a move, which the next one follows soon.
  const bool in_haste = before != Light::unknown && !settings_.bounces && enough(0);
  if (gather_.direct() == Direct::exact && (changed || (lamps_.is_rough() && !in_haste)))
    times.time("direct_light", [&] {
      lamps_.light(offsets(), scales(), moves, in_haste ? LampLight::Care::rough : LampLight::Care::whole);
    });
  if (moves.any()) link(moves, solution);
  const progress::Work work("bounces");
  const bool settled = times.time("bounces", [&] { return converge(before, enough, solution); });
  times.time("average", [&] { finish(); });
  return settled;
}

void Rays::link(const Moves& moves, Solution& solution) {
  auto& times = device_.times();
  times.time("links", [&] { links_.link(offsets(), moves); });
  times.time("block_filter", [&] { filter_.renew(links_.changed()); });
  gather_.find_sources();
  count_rays(solution);
}

// As many bounces as are asked for; or until the bound is met, or falls no more, for rounding. True if that is
// it.
bool Rays::converge(Light before, const Enough& enough, Solution& solution) {
  const bool exact = gather_.direct() == Direct::exact;
  const bool afresh = before == Light::unknown || settings_.bounces;
  if (afresh) gather_.start();
  if (afresh && exact) solution.bounces = 1;
  const auto direct = gather_.set_lamps(lamps_.irradiance());
  if (settings_.bounces) {
    solution.residual = bound_on_missing(direct.most, records_.highest_albedo(), direct.mean);
    while (solution.bounces < *settings_.bounces) bounce(solution);
    return true;
  }
  // The first map is never one of a room that is half lit.
  const auto may_end = [&](std::uint32_t bounces) { return before != Light::unknown && enough(bounces); };
  return bounce_until_converged(
      solution, [&] { bounce(solution); }, may_end);
}

void Rays::bounce(Solution& solution) {
  const auto change = gather_.bounce();
  ++solution.bounces;
  solution.residual = bound_on_missing(change.most, records_.highest_albedo(), change.mean);
}

void Rays::count_rays(Solution& solution) const {
  solution.texels_valid = records_.count();
  solution.rays = solution.misses = 0;
  for (std::uint32_t row = 0; row < rows_.count(); ++row) {
    solution.rays += links_.valid(row)[0] + links_.valid(row)[1];
    solution.misses += links_.misses(row);
  }
}

void Rays::finish() {
  const auto& soft = lamps_.soft_irradiance();
  std::vector<glm::vec4> own(rows_.count());  // which differs by the sets
  for (std::uint32_t row = 0; row < rows_.count(); ++row)
    own[row] = gather_.gathered()[row] + glm::vec4(soft[row], 0);
  filter_.average(own, averages_);
  const auto irradiance_of = [&](std::uint32_t row) {
    return glm::max(glm::vec3(averages_[row]), 0.0f) + (lamps_.irradiance()[row] - soft[row]);
  };
  for_each_index(0, rows_.count(), rows_of_a_task, [&](std::uint32_t row) {
    if (const auto texel = rows_[row].atlas; texel != no_atlas_texel)
      irradiance_[texel] = glm::vec4(irradiance_of(row), 1);
  });
  for (const auto& [texel, row] : rows_.shown_beside()) irradiance_[texel] = glm::vec4(irradiance_of(row), 0);
}

double Rays::error_estimate() const {
  std::vector<glm::vec4> own(rows_.count()), averages(rows_.count()), half(irradiance_.size(), glm::vec4(0));
  for (std::uint32_t row = 0; row < rows_.count(); ++row)
    own[row] = gather_.half_difference()[row] + glm::vec4(lamps_.half_difference(row, true), 0);
  filter_.average(own, averages);
  for (std::uint32_t row = 0; row < rows_.count(); ++row)
    if (rows_[row].atlas != no_atlas_texel)
      half[rows_[row].atlas] = averages[row] + glm::vec4(lamps_.half_difference(row, false), 0);
  return split_half_error(irradiance_, half);
}

Shown Rays::shown(const Adaptation& adaptation) {
  if (!presenter_) presenter_.emplace(device_, scene_, records_);
  std::vector<float> covered(irradiance_.size(), 0);
  for (std::uint32_t row = 0; row < rows_.count(); ++row)
    if (rows_[row].atlas != no_atlas_texel && links_.buried(row)) covered[rows_[row].atlas] = 1;
  std::vector<Over::Instead> instead;
  for (const auto& [texel, row] : rows_.shown_beside()) {
    const auto& record = rows_[row];
    instead.push_back({texel, scales()[scene_.surfaces[record.surface].light] * record.emission +
                                  record.albedo / std::numbers::pi_v<float> * glm::vec3(irradiance_[texel])});
  }
  presenter_->dim(scales());
  return presenter_->show(irradiance_, adaptation, covered, instead);
}

}  // namespace lichtveld::lightfield
