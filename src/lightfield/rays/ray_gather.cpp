#include "rays/ray_gather.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "core/parallel.hpp"

namespace lichtveld::lightfield {

namespace {

using std::numbers::pi_v;

constexpr std::uint32_t rows_of_a_task = 512;

// Four channels that are added at once, on any processor: one load a link.
using Float4 [[gnu::vector_size(16), gnu::may_alias]] = float;

Float4 sum_of(const Float4* radiance, std::span<const std::uint32_t> links) {
  Float4 even{}, odd{};
  std::size_t i = 0;
  for (; i + 2 <= links.size(); i += 2) {
    even += radiance[links[i]];
    odd += radiance[links[i + 1]];
  }
  if (i < links.size()) even += radiance[links[i]];
  return even + odd;
}

glm::vec4 as_vec4(const Float4& value) {
  return {value[0], value[1], value[2], value[3]};
}

}  // namespace

RayGather::RayGather(const Rows& rows, const RayLinks& links, Direct direct)
    : rows_(rows),
      links_(links),
      direct_(direct),
      radiance_(std::size_t{rows.count()} + 2, glm::vec4(0)),
      own_radiance_(radiance_),
      gathered_(rows.count(), glm::vec4(0)),
      half_difference_(rows.count(), glm::vec4(0)),
      lamps_(rows.count(), glm::vec3(0)),
      source_(rows.count()) {}

void RayGather::find_sources() {
  for_each_index(0, rows_.count(), rows_of_a_task,
                 [&](std::uint32_t row) { source_[row] = links_.buried(row) ? open_neighbour(row) : row; });
}

std::uint32_t RayGather::open_neighbour(std::uint32_t row) const {
  constexpr int reach = 2;  // texels
  std::uint32_t found = row;
  int best = std::numeric_limits<int>::max();
  rows_.for_each_around(row, reach, [&](std::uint32_t other, int dx, int dy) {
    const int distance = dx * dx + dy * dy;
    if (distance >= best || links_.buried(other) || !rows_.same_face(row, other)) return;
    best = distance;
    found = other;
  });
  return found;
}

void RayGather::start() {
  std::ranges::fill(gathered_, glm::vec4(0));
  std::ranges::fill(half_difference_, glm::vec4(0));
  send();
}

RayGather::Change RayGather::set_lamps(std::span<const glm::vec3> irradiance) {
  std::ranges::copy(irradiance, lamps_.begin());
  send();
  Change change;
  for (const auto& light : lamps_) {
    change.most = std::max(change.most, double{std::max({light.r, light.g, light.b})});
    change.mean += (double{light.r} + light.g + light.b) / (3.0 * rows_.count());
  }
  return change;
}

// L = albedo / pi * E; with Direct::psf what glows sends its light along the rays, too.
void RayGather::send() {
  for_each_index(0, rows_.count(), rows_of_a_task, [&](std::uint32_t row) {
    own_radiance_[row] = sent(row, row);
    radiance_[row] = source_[row] == row ? own_radiance_[row] : sent(row, source_[row]);
  });
}

// L of a row with the E of another.
glm::vec4 RayGather::sent(std::uint32_t row, std::uint32_t source) const {
  const glm::vec3 reflected = rows_[row].albedo / pi_v<float> * (lamps_[source] + glm::vec3(gathered_[source]));
  return glm::vec4(reflected + (direct_ == Direct::psf ? rows_[row].emission : glm::vec3(0)), 0);
}

RayGather::Change RayGather::bounce() {
  const std::uint32_t half = (links_.rays() + 1) / 2,
                      tasks = (rows_.count() + rows_of_a_task - 1) / rows_of_a_task;
  std::vector<Change> changes(tasks);
  const auto* of_open = reinterpret_cast<const Float4*>(radiance_.data());
  const auto* of_buried = reinterpret_cast<const Float4*>(own_radiance_.data());
  for_each_index(0, tasks, 1, [&](std::uint32_t task) {
    auto& [most, sum] = changes[task];
    const auto first = task * rows_of_a_task, end = std::min(first + rows_of_a_task, rows_.count());
    for (auto row = first; row < end; ++row) {
      const auto links = links_.of(row);
      // What is buried sees other buried places as they are.
      const auto* radiance = links_.buried(row) ? of_buried : of_open;
      const auto valid = links_.valid(row);
      const glm::vec4 a = as_vec4(sum_of(radiance, links.first(half))),
                      b = as_vec4(sum_of(radiance, links.subspan(half)));
      const float of_a = pi_v<float> / static_cast<float>(std::max(valid[0], 1u)),
                  of_both = pi_v<float> / static_cast<float>(std::max(valid[0] + valid[1], 1u));
      const glm::vec4 gathered = of_both * (a + b);
      for (int channel = 0; channel < 3; ++channel) {
        most = std::max(most, std::abs(double{gathered[channel]} - gathered_[row][channel]));
        sum += double{gathered[channel]} + lamps_[row][channel];
      }
      gathered_[row] = gathered;
      half_difference_[row] = valid[0] > 0 && valid[1] > 0 ? of_a * a - gathered : glm::vec4(0);
    }
  });
  Change change;
  for (const auto& [most, sum] : changes) {
    change.most = std::max(change.most, most);
    change.mean += sum;
  }
  change.mean /= 3.0 * rows_.count();
  send();
  return change;
}

}  // namespace lichtveld::lightfield
