#include "rays/ray_links.hpp"

#include <algorithm>
#include <utility>

#include "core/parallel.hpp"
#include "lichtveld/progress/progress.hpp"

namespace lichtveld::lightfield {

namespace {

constexpr std::uint32_t packets_of_a_task = 16;
// What most rays meet nearer than this lies on the texel [its sides].
constexpr float buried_distance = 0.25f;

}  // namespace

RayLinks::RayLinks(const scene::RayIndex& index, const scene::Scene& scene, const Rows& rows,
                   const RaySets& sets, std::vector<char> hidden)
    : rows_(rows),
      search_(index, scene, rows, sets),
      own_(std::size_t{rows.count()} * sets.rays(), boost::container::default_init),
      seen_(own_.size(), boost::container::default_init),
      own_distance_(own_.size(), boost::container::default_init),
      distance_(own_.size(), boost::container::default_init),
      covers_(rows.bodies(), std::vector<Covers>(rows.bodies())),
      reset_(own_.size()),
      valid_(rows.count()),
      hidden_(std::move(hidden)),
      buried_(rows.count()),
      misses_(rows.count()) {}

void RayLinks::link(const scene::Offsets& offsets, const Moves& moves) {
  offsets_ = offsets;
  touched_.assign(rows_.count(), 0);
  const std::uint32_t bodies = rows_.bodies();
  for (std::uint32_t body = 1; body < bodies; ++body)
    for (std::uint32_t receiver = 0; receiver < bodies; ++receiver)
      if (moves.has(body) && !moves.has(receiver)) uncover(covers_[body][receiver]);
  for (std::uint32_t body = 0; body < bodies; ++body)
    if (moves.has(body)) find_own(body);
  for (std::uint32_t receiver = 0; receiver < bodies; ++receiver)
    for (std::uint32_t body = 1; body < bodies; ++body) {
      if (body == receiver) continue;
      const bool anew = moves.has(body) || moves.has(receiver);
      auto& covers = covers_[body][receiver];
      if (anew)
        covers = search_.find_covers(body, receiver, offsets_, {own_distance_.data(), own_distance_.size()});
      cover(covers, anew);
    }
  for (const std::size_t ray : uncovered_) reset_[ray] = false;
  uncovered_.clear();
  for_each_index(0, rows_.count(), 256, [&](std::uint32_t row) {
    if (!touched_[row]) return;
    const auto near = [&](float distance) { return distance <= buried_distance * rows_[row].side; };
    buried_[row] = hidden_[row] || 2 * std::ranges::count_if(distances(row), near) > std::ssize(distances(row));
    misses_[row] = covered(row) ? 0 : static_cast<std::uint32_t>(std::ranges::count(of(row), nothing()));
  });
  changed_.clear();
  for (std::uint32_t row = 0; row < rows_.count(); ++row)
    if (touched_[row]) changed_.push_back(row);
}

// What stands still, and the row's own body, which moves with it.
void RayLinks::find_own(std::uint32_t body) {
  const auto packets = rows_.packets_of_body(body);
  progress::Work work("links", packets.size());
  for_each_index(packets.first, packets.end, packets_of_a_task, [&](std::uint32_t packet) {
    search_.find_own(rows_.packets()[packet], offsets_, {own_.data(), own_.size()},
                     {own_distance_.data(), own_distance_.size()}, valid_);
    work.done();
  });
  const auto rows = rows_.of_body(body);
  const auto first = static_cast<std::ptrdiff_t>(std::size_t{rows.first} * rays()),
             end = static_cast<std::ptrdiff_t>(std::size_t{rows.end} * rays());
  std::copy(own_.begin() + first, own_.begin() + end, seen_.begin() + first);
  std::copy(own_distance_.begin() + first, own_distance_.begin() + end, distance_.begin() + first);
  std::fill(touched_.begin() + rows.first, touched_.begin() + rows.end, 1);
}

void RayLinks::uncover(const Covers& covers) {
  for (const Cover& cover : covers) {
    seen_[cover.ray] = own_[cover.ray];
    distance_[cover.ray] = own_distance_[cover.ray];
    touched_[cover.ray / rays()] = 1;
    if (reset_[cover.ray]) continue;
    reset_[cover.ray] = true;
    uncovered_.push_back(cover.ray);
  }
}

// `anew`: all of them; otherwise those of rays that another body has set free.
void RayLinks::cover(const Covers& covers, bool anew) {
  if (!anew && uncovered_.empty()) return;
  for (const auto& [ray, seen, distance] : covers) {
    if (!anew && !reset_[ray]) continue;
    // Of two at the same distance the same one, whichever comes first.
    if (std::pair(distance, seen) >= std::pair(distance_[ray], seen_[ray])) continue;
    seen_[ray] = seen;
    distance_[ray] = distance;
    touched_[ray / rays()] = 1;
  }
}

}  // namespace lichtveld::lightfield
