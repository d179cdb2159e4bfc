#include "rays/ray_links.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/parallel.hpp"

namespace lichtveld::lightfield {

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr std::uint32_t packets_of_a_task = 16;
// What most rays meet nearer than this lies on the texel [its sides].
constexpr float buried_distance = 0.25f;

// A packet's places and the directions that each looks along.
class Starts {
 public:
  Starts(const Rows& rows, const RaySets& sets, const Range& packet, const glm::vec3& offset, float lift) {
    for (std::uint32_t row = packet.first; row < packet.end; ++row) {
      const auto& record = rows[row];
      place[count] = record.position + offset + lift * record.face;
      face[count] = record.face;
      frame_[count] = frame_about(record.normal);
      directions_[count] = sets[rows.set(row)];
      alike = alike && record.normal == rows[packet.first].normal && record.face == face[0] &&
              rows.set(row) == rows.set(packet.first);
      low = glm::min(low, place[count]);
      high = glm::max(high, place[count]);
      ++count;
    }
  }

  glm::vec3 direction(std::uint32_t lane, std::uint32_t number) const {
    return frame_[lane] * directions_[lane][number];
  }

  // The rays of that number; without those that leave below their face.
  void rays(std::uint32_t number, scene::RayPacket& rays) const {
    rays.lanes = 0;
    glm::vec3 along = direction(0, number);
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      if (!alike) along = direction(lane, number);
      rays.set(lane, place[lane], along);
      if (glm::dot(along, face[lane]) > 0) rays.lanes |= 1u << lane;
    }
    // Embree reads the others, too.
    for (std::uint32_t lane = count; lane < scene::RayPacket::size; ++lane) rays.set(lane, place[0], along);
  }

  // Whether some of a box is above the face of any place.
  bool see(const scene::Box& box) const {
    const glm::vec3 middle = (box.min + box.max) / 2.0f, half = (box.max - box.min) / 2.0f;
    for (std::uint32_t lane = 0; lane < count; ++lane)
      if (glm::dot(face[lane], middle - place[lane]) + glm::dot(glm::abs(face[lane]), half) > 0) return true;
    return false;
  }

  std::uint32_t count = 0;
  std::array<glm::vec3, scene::RayPacket::size> place, face;
  glm::vec3 low{infinite}, high{-infinite};
  bool alike = true;  // one direction for all

 private:
  std::array<glm::mat3, scene::RayPacket::size> frame_;
  std::array<std::span<const glm::vec3>, scene::RayPacket::size> directions_;
};

// For each direction whether a ray from the origin may meet a box: by its slabs (Kay and Kajiya 1986).
class Slabs {
 public:
  explicit Slabs(std::uint32_t directions)
      : x_(directions), y_(directions), z_(directions), misses_(directions) {}

  void set(std::uint32_t number, const glm::vec3& direction) {
    x_[number] = 1 / direction.x, y_[number] = 1 / direction.y, z_[number] = 1 / direction.z;
  }

  // 1 for those that miss it.
  const std::vector<std::uint32_t>& misses(const glm::vec3& low, const glm::vec3& high) {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const float ax = low.x * x_[i], bx = high.x * x_[i], ay = low.y * y_[i], by = high.y * y_[i],
                  az = low.z * z_[i], bz = high.z * z_[i];
      const float first =
          std::max(std::max(std::min(ax, bx), std::min(ay, by)), std::max(std::min(az, bz), 0.0f));
      const float last = std::min(std::min(std::max(ax, bx), std::max(ay, by)), std::max(az, bz));
      misses_[i] = first > last;
    }
    return misses_;
  }

 private:
  std::vector<float> x_, y_, z_;  // one over each direction
  std::vector<std::uint32_t> misses_;
};

}  // namespace

RayLinks::RayLinks(const scene::RayIndex& index, const scene::Scene& scene, const Rows& rows,
                   const RaySets& sets)
    : index_(index),
      scene_(scene),
      rows_(rows),
      sets_(sets),
      own_(std::size_t{rows.count()} * sets.rays()),
      seen_(own_.size()),
      own_distance_(own_.size()),
      distance_(own_.size()),
      covers_(rows.bodies(), std::vector<Covers>(rows.bodies())),
      reset_(own_.size()),
      valid_(rows.count()),
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
      if (anew) covers = find_covers(body, receiver);
      cover(covers, anew);
    }
  for (const std::size_t ray : uncovered_) reset_[ray] = false;
  uncovered_.clear();
  for_each_index(0, rows_.count(), 256, [&](std::uint32_t row) {
    if (!touched_[row]) return;
    const auto near = [&](float distance) { return distance <= buried_distance * rows_[row].side; };
    buried_[row] = 2 * std::ranges::count_if(distances(row), near) > std::ssize(distances(row));
    misses_[row] = covered(row) ? 0 : static_cast<std::uint32_t>(std::ranges::count(of(row), nothing()));
  });
  changed_.clear();
  for (std::uint32_t row = 0; row < rows_.count(); ++row)
    if (touched_[row]) changed_.push_back(row);
}

// What stands still, and the row's own body, which moves with it.
void RayLinks::find_own(std::uint32_t body) {
  const auto packets = rows_.packets_of_body(body);
  for_each_index(packets.first, packets.end, packets_of_a_task,
                 [&](std::uint32_t packet) { find_own(rows_.packets()[packet], body); });
  const auto rows = rows_.of_body(body);
  const auto first = static_cast<std::ptrdiff_t>(std::size_t{rows.first} * rays()),
             end = static_cast<std::ptrdiff_t>(std::size_t{rows.end} * rays());
  std::copy(own_.begin() + first, own_.begin() + end, seen_.begin() + first);
  std::copy(own_distance_.begin() + first, own_distance_.begin() + end, distance_.begin() + first);
  std::fill(touched_.begin() + rows.first, touched_.begin() + rows.end, 1);
}

void RayLinks::find_own(const Range& packet, std::uint32_t body) {
  const Starts starts(rows_, sets_, packet, offsets_[body], index_.skin() / 2);
  scene::RayPacket along;
  scene::HitPacket hits;
  std::array<std::array<std::uint32_t, 2>, scene::RayPacket::size> valid{};
  for (std::uint32_t number = 0; number < rays(); ++number) {
    starts.rays(number, along);
    hits.clear(infinite);
    index_.nearest(0, {}, along, hits);
    if (body != 0) index_.nearest(body, offsets_[body], along, hits);
    for (std::uint32_t lane = 0; lane < starts.count; ++lane) {
      const std::size_t ray = std::size_t{packet.first + lane} * rays() + number;
      const bool is_one = along.lanes >> lane & 1;
      own_[ray] = is_one ? seen(hits, lane) : outside();
      valid[lane][number < (rays() + 1) / 2 ? 0 : 1] += is_one;
      own_distance_[ray] = hits.distance[lane];
    }
  }
  for (std::uint32_t lane = 0; lane < starts.count; ++lane) {
    const std::uint32_t row = packet.first + lane;
    valid_[row] = valid[lane];
    if (!contact(row, 0) && (body == 0 || !contact(row, body))) continue;
    const auto first = static_cast<std::ptrdiff_t>(std::size_t{row} * rays());
    std::fill_n(own_.begin() + first, rays(), nothing());
    std::fill_n(own_distance_.begin() + first, rays(), 0.0f);
  }
}

std::uint32_t RayLinks::seen(const scene::HitPacket& hits, std::uint32_t lane) const {
  if (hits.triangle[lane] == scene::HitPacket::none) return nothing();
  const auto row =
      rows_.seen({hits.triangle[lane], {hits.u[lane], hits.v[lane]}}, hits.from_behind >> lane & 1);
  return row == no_row ? nothing() : row;
}

// Whether a body lies on a row.
bool RayLinks::contact(std::uint32_t row, std::uint32_t body) const {
  const auto& record = rows_[row];
  return index_.contact(body, offsets_[body], record.position + offsets_[record.body], record.face,
                        record.triangle);
}

RayLinks::Covers RayLinks::find_covers(std::uint32_t body, std::uint32_t receiver) const {
  const auto packets = rows_.packets_of_body(receiver);
  const std::uint32_t tasks = (packets.size() + packets_of_a_task - 1) / packets_of_a_task;
  std::vector<Covers> of_task(tasks);
  for_each_index(0, tasks, 1, [&](std::uint32_t task) {
    const std::uint32_t first = packets.first + task * packets_of_a_task;
    for (auto packet = first; packet < std::min(first + packets_of_a_task, packets.end); ++packet)
      find_covers(body, rows_.packets()[packet], receiver, of_task[task]);
  });
  Covers all;
  for (const auto& some : of_task) all.insert(all.end(), some.begin(), some.end());
  return all;
}

void RayLinks::find_covers(std::uint32_t body, const Range& packet, std::uint32_t receiver,
                           Covers& covers) const {
  const Starts starts(rows_, sets_, packet, offsets_[receiver], index_.skin() / 2);
  const glm::vec3 skin(index_.skin());
  const scene::Box& rest = scene_.bodies[body].box;
  const scene::Box box{rest.min + offsets_[body] - skin, rest.max + offsets_[body] + skin};
  if (!starts.see(box)) return;
  std::uint32_t in_contact = 0;
  if (glm::all(glm::lessThanEqual(starts.low, box.max)) &&
      glm::all(glm::greaterThanEqual(starts.high, box.min)))
    for (std::uint32_t lane = 0; lane < starts.count; ++lane)
      if (contact(packet.first + lane, body)) {
        in_contact |= 1u << lane;
        for (std::uint32_t number = 0; number < rays(); ++number)
          covers.push_back({std::size_t{packet.first + lane} * rays() + number, nothing(), 0});
      }
  // Lane by lane, or for all of one direction at once: whatever starts between the lowest and the highest
  // place.
  std::vector<std::uint32_t> lanes(rays(), 0);
  Slabs slabs(rays());
  for (std::uint32_t lane = 0; lane < (starts.alike ? 1 : starts.count); ++lane) {
    for (std::uint32_t number = 0; number < rays(); ++number) slabs.set(number, starts.direction(lane, number));
    const auto& misses = starts.alike
                             ? slabs.misses(box.min - starts.high, box.max - starts.low)
                             : slabs.misses(box.min - starts.place[lane], box.max - starts.place[lane]);
    for (std::uint32_t number = 0; number < rays(); ++number)
      if (!misses[number]) lanes[number] |= starts.alike ? ~0u : 1u << lane;
  }
  scene::RayPacket along;
  scene::HitPacket hits;
  for (std::uint32_t number = 0; number < rays(); ++number) {
    lanes[number] &= ~in_contact;
    if (lanes[number] == 0) continue;
    starts.rays(number, along);
    along.lanes &= lanes[number];
    hits.clear(0);
    for (std::uint32_t lane = 0; lane < starts.count; ++lane)
      hits.distance[lane] = own_distance_[std::size_t{packet.first + lane} * rays() + number];
    index_.nearest(body, offsets_[body], along, hits);
    for (std::uint32_t lane = 0; lane < starts.count; ++lane)
      if (hits.triangle[lane] != scene::HitPacket::none)
        covers.push_back(
            {std::size_t{packet.first + lane} * rays() + number, seen(hits, lane), hits.distance[lane]});
  }
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
