#include "rays/block_filter.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"

namespace lichtveld::lightfield {

namespace {

constexpr std::uint32_t rows_of_a_task = 256;
// Of the harmonic mean of what a texel sees.
constexpr float reach_share = 0.5f;
// A plane is fitted to the texels around if they are spread at least so well both ways, in squares of a texel.
constexpr float least_spread = 0.2f;

float harmonic_mean(std::span<const float> distances) {
  float sum = 0;
  for (const float distance : distances) sum += 1 / distance;
  return static_cast<float>(distances.size()) / sum;
}

}  // namespace

BlockFilter::BlockFilter(const Rows& rows, const RayLinks& links, std::uint32_t side)
    : rows_(rows),
      links_(links),
      radius_(static_cast<int>(side) / 2),
      reach_(rows.count()),
      taps_(side > 1 ? rows.count() : 0) {}

void BlockFilter::renew(std::span<const std::uint32_t> rows) {
  if (taps_.empty()) return;
  std::vector<char> wanted(rows_.count(), 0), opened_or_closed(rows.size());
  for_each_index(0, static_cast<std::uint32_t>(rows.size()), rows_of_a_task, [&](std::uint32_t i) {
    const auto row = rows[i];
    const bool buried = links_.buried(row);
    const float before = reach_[row];
    opened_or_closed[i] = buried != (before <= 0);
    reach_[row] = buried ? 0 : reach_share * harmonic_mean(links_.distances(row));
    // As long as the whole block is near enough, it does not matter how near.
    const float whole = 1.5f * static_cast<float>(radius_) * rows_[row].side;
    wanted[row] = opened_or_closed[i] || std::min(before, reach_[row]) < whole;
  });
  // Nobody takes from what is buried.
  if (rows.size() < rows_.count())
    for (std::uint32_t i = 0; i < rows.size(); ++i)
      if (opened_or_closed[i])
        rows_.for_each_around(rows[i], radius_, [&](std::uint32_t other, int, int) { wanted[other] = 1; });
  for_each_index(0, rows_.count(), rows_of_a_task, [&](std::uint32_t row) {
    if (wanted[row]) find(row);
  });
}

void BlockFilter::find(std::uint32_t row) {
  const TexelRecord& own = rows_[row];
  Taps& taps = taps_[row];
  taps.count = 0;
  const auto add = [&](std::uint32_t of, float weight) {
    taps.row[taps.count] = of;
    taps.weight[taps.count++] = weight;
  };
  if (own.atlas == no_atlas_texel || reach_[row] <= 0) return add(row, 1);
  glm::vec2 at[most_taps];
  rows_.for_each_around(row, radius_, [&](std::uint32_t other, int dx, int dy) {
    if (reach_[other] <= 0 || !rows_.same_face(row, other) ||
        glm::distance(rows_[other].position, own.position) > reach_[row])
      return;
    at[taps.count] = glm::vec2(dx, dy);
    // The block's rim counts half on either side, so that each set counts the same.
    add(other, (std::abs(dx) == radius_ ? 0.5f : 1.0f) * (std::abs(dy) == radius_ ? 0.5f : 1.0f));
  });
  // The weights w (1 + g . (at - mean)) have their mean where the texel is.
  float sum = 0;
  glm::vec2 mean(0);
  for (std::uint32_t i = 0; i < taps.count; ++i) sum += taps.weight[i], mean += taps.weight[i] * at[i];
  mean /= sum;
  float xx = 0, xy = 0, yy = 0;
  for (std::uint32_t i = 0; i < taps.count; ++i) {
    const glm::vec2 apart = at[i] - mean;
    xx += taps.weight[i] * apart.x * apart.x;
    xy += taps.weight[i] * apart.x * apart.y;
    yy += taps.weight[i] * apart.y * apart.y;
  }
  xx /= sum, xy /= sum, yy /= sum;
  const float determinant = xx * yy - xy * xy;
  glm::vec2 gradient(0);
  if (mean != glm::vec2(0) && determinant > least_spread * least_spread)
    gradient = glm::vec2(xy * mean.y - yy * mean.x, xy * mean.x - xx * mean.y) / determinant;
  for (std::uint32_t i = 0; i < taps.count; ++i) taps.weight[i] *= (1 + glm::dot(gradient, at[i] - mean)) / sum;
}

void BlockFilter::average(std::span<const glm::vec4> values, std::span<glm::vec4> averages) const {
  if (taps_.empty()) {
    std::ranges::copy(values, averages.begin());
    return;
  }
  for_each_index(0, rows_.count(), rows_of_a_task, [&](std::uint32_t row) {
    const Taps& taps = taps_[row];
    glm::vec4 sum(0);
    for (std::uint32_t i = 0; i < taps.count; ++i) sum += taps.weight[i] * values[taps.row[i]];
    averages[row] = sum;
  });
}

}  // namespace lichtveld::lightfield
