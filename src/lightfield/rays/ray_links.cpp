#include "rays/ray_links.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "core/parallel.hpp"

namespace lichtveld::lightfield {

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr std::uint32_t packets_of_a_task = 16, packets_of_a_search = 128;
// What most rays meet nearer than this lies on the texel [its sides].
constexpr float buried_distance = 0.25f;

// A packet's places and the directions that each looks along.
class Starts {
 public:
  static constexpr std::uint32_t most = scene::RayPacket::size;

  Starts(const Rows& rows, const RaySets& sets, const Rows::Packet& packet, const glm::vec3& offset, float lift)
      : count(packet.size()), alike(packet.alike), first_(&rows[packet.first]) {
    for (std::uint32_t lane = 0; lane < most; ++lane) {
      // Embree reads what is none, too.
      const auto row = std::min(packet.first + lane, packet.end - 1);
      const glm::vec3 from = rows[row].position + offset + lift * rows[row].face;
      x[lane] = from.x, y[lane] = from.y, z[lane] = from.z;
      directions_[lane] = sets[rows.set(row)];
    }
    for (std::uint32_t lane = 0; lane < (alike ? 1 : count); ++lane)
      frame_[lane] = frame_about(first_[lane].normal);
  }

  glm::vec3 place(std::uint32_t lane) const { return {x[lane], y[lane], z[lane]}; }
  const glm::vec3& face(std::uint32_t lane) const { return first_[lane].face; }
  glm::vec3 direction(std::uint32_t lane, std::uint32_t number) const {
    return alike ? frame_[0] * directions_[0][number] : frame_[lane] * directions_[lane][number];
  }

  // The rays of that number, which leave above their face.
  void rays(std::uint32_t number, scene::RayPacket& rays) const {
    rays.x = x, rays.y = y, rays.z = z;
    rays.lanes = 0;
    for (std::uint32_t lane = 0; lane < most; ++lane) {
      const std::uint32_t of = alike || lane >= count ? 0 : lane;
      const glm::vec3 along =
          lane == of ? direction(of, number) : glm::vec3(rays.dx[0], rays.dy[0], rays.dz[0]);
      rays.dx[lane] = along.x, rays.dy[lane] = along.y, rays.dz[lane] = along.z;
      if (lane < count && glm::dot(along, face(lane)) > 0) rays.lanes |= 1u << lane;
    }
  }

  // Whether any may see the body that it is of.
  bool meet_own_body(const scene::RayIndex& index) const {
    for (std::uint32_t lane = 0; lane < count; ++lane)
      if (index.may_meet_own_body(first_[lane].triangle, face(lane))) return true;
    return false;
  }

  std::uint32_t count;
  bool alike;                       // one direction for all
  scene::RayPacket::Lanes x, y, z;  // [m]

 private:
  const TexelRecord* first_;  // of the packet's
  std::array<glm::mat3, most> frame_;
  std::array<std::span<const glm::vec3>, most> directions_;
};

// Arrays of coordinates, or one place for all.
struct Coordinates {
  const float *x, *y, *z;
};

// Where rays enter a box, by its slabs (Kay and Kajiya 1986): infinite for those that miss it. Ray i starts
// between from[i * place_step] and to[i * place_step]; inverse[i * direction_step]: one over its direction.
// Written so that compilers do several at once.
template <std::size_t place_step, std::size_t direction_step>
void enter(const scene::Box& box, std::size_t count, const Coordinates& from, const Coordinates& to,
           const Coordinates& inverse, float* entries) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t p = i * place_step, d = i * direction_step;
    const float ax = (box.min.x - to.x[p]) * inverse.x[d], bx = (box.max.x - from.x[p]) * inverse.x[d],
                ay = (box.min.y - to.y[p]) * inverse.y[d], by = (box.max.y - from.y[p]) * inverse.y[d],
                az = (box.min.z - to.z[p]) * inverse.z[d], bz = (box.max.z - from.z[p]) * inverse.z[d];
    const float first =
        std::max(std::max(std::min(ax, bx), std::min(ay, by)), std::max(std::min(az, bz), 0.0f));
    const float last = std::min(std::min(std::max(ax, bx), std::max(ay, by)), std::max(az, bz));
    entries[i] = first <= last ? first : infinite;
  }
}

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

void RayLinks::find_own(const Rows::Packet& packet, std::uint32_t body) {
  const Starts starts(rows_, sets_, packet, offsets_[body], index_.skin() / 2);
  const bool meets_body = body != 0 && starts.meet_own_body(index_);
  std::uint32_t looking = 0;  // those that nothing lies on
  for (std::uint32_t lane = 0; lane < starts.count; ++lane) {
    const std::uint32_t row = packet.first + lane;
    valid_[row] = {};
    if (!contact(row, 0) && (!meets_body || !contact(row, body))) looking |= 1u << lane;
  }
  scene::RayPacket along;
  scene::HitPacket hits;
  for (std::uint32_t number = 0; number < rays(); ++number) {
    starts.rays(number, along);
    const std::uint32_t leaving = std::exchange(along.lanes, along.lanes & looking);
    hits.clear(infinite);
    if (along.lanes != 0) index_.nearest(0, {}, along, hits);
    if (along.lanes != 0 && meets_body) index_.nearest(body, offsets_[body], along, hits);
    for (std::uint32_t lane = 0; lane < starts.count; ++lane) {
      const std::size_t ray = std::size_t{packet.first + lane} * rays() + number;
      const bool leaves = leaving >> lane & 1, looks = looking >> lane & 1;
      valid_[packet.first + lane][number < (rays() + 1) / 2 ? 0 : 1] += leaves;
      own_[ray] = !looks ? nothing() : leaves ? seen(hits, lane) : outside();
      own_distance_[ray] = looks ? hits.distance[lane] : 0.0f;
    }
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

// Of the rays of rows those that may meet a body, whatever rows they start from, so that packets are full.
class RayLinks::Search {
 public:
  Search(const RayLinks& links, std::uint32_t body, std::uint32_t receivers, Covers& covers)
      : links_(links),
        body_(body),
        offset_(links.offsets_[receivers]),
        box_(shifted(links.scene_.bodies[body].box, links.offsets_[body], links.index_.skin())),
        covers_(covers),
        inverses_(links.sets_.sets()),
        entries_(links.rays()) {}

  void look(const Rows::Packet& packet) {
    const scene::Box places = shifted(packet.box, offset_, 0);
    if (packet.alike && !sees(links_.rows_[packet.first].face, packet.box)) return;
    const std::uint32_t looking = looks_beside_contacts(packet, places);
    if (packet.alike)
      look_together(packet, places, looking);
    else
      look_apart(packet, looking);
  }

  void trace() {
    if (count_ == 0) return;
    for (std::uint32_t lane = count_; lane < scene::RayPacket::size; ++lane)  // Embree reads the others, too
      along_.set(lane, {along_.x[0], along_.y[0], along_.z[0]}, {along_.dx[0], along_.dy[0], along_.dz[0]});
    along_.lanes = (1u << count_) - 1;
    scene::HitPacket hits;
    hits.clear(0);
    std::copy_n(reach_.begin(), count_, hits.distance.begin());
    links_.index_.nearest(body_, links_.offsets_[body_], along_, hits);
    for (std::uint32_t lane = 0; lane < count_; ++lane)
      if (hits.triangle[lane] != scene::HitPacket::none)
        covers_.push_back({ray_[lane], links_.seen(hits, lane), hits.distance[lane]});
    count_ = 0;
  }

 private:
  static constexpr std::uint32_t lanes = scene::RayPacket::size;

  // One over each direction.
  struct Inverse {
    glm::vec3 normal{0};  // that they are about
    std::vector<float> x = {}, y = {}, z = {};

    template <typename Direction>
    void set(const glm::vec3& about, std::uint32_t count, const Direction& direction) {
      normal = about;
      x.resize(count), y.resize(count), z.resize(count);
      for (std::uint32_t number = 0; number < count; ++number) {
        const glm::vec3 inverse = 1.0f / direction(number);
        x[number] = inverse.x, y[number] = inverse.y, z[number] = inverse.z;
      }
    }
    Coordinates all() const { return {x.data(), y.data(), z.data()}; }
  };

  static scene::Box shifted(const scene::Box& box, const glm::vec3& by, float grown) {
    return {box.min + by - grown, box.max + by + grown};
  }

  // Whether some of the body's box is above a face that is somewhere in a box.
  bool sees(const glm::vec3& face, const scene::Box& places) const {
    const glm::vec3 from = (places.min + places.max) / 2.0f + offset_, to = (box_.min + box_.max) / 2.0f;
    const glm::vec3 half = (places.max - places.min + box_.max - box_.min) / 2.0f;
    return glm::dot(face, to - from) + glm::dot(glm::abs(face), half) > 0;
  }

  // A bit for each row of a packet on which the body does not lie; of others nothing is seen.
  std::uint32_t looks_beside_contacts(const Rows::Packet& packet, const scene::Box& places) {
    std::uint32_t looking = (1u << packet.size()) - 1;
    if (glm::any(glm::greaterThan(places.min, box_.max)) || glm::any(glm::lessThan(places.max, box_.min)))
      return looking;
    for (std::uint32_t lane = 0; lane < packet.size(); ++lane)
      if (links_.contact(packet.first + lane, body_)) {
        looking &= ~(1u << lane);
        for (std::uint32_t number = 0; number < links_.rays(); ++number)
          covers_.push_back({std::size_t{packet.first + lane} * links_.rays() + number, links_.nothing(), 0});
      }
    return looking;
  }

  void look_together(const Rows::Packet& packet, const scene::Box& places, std::uint32_t looking) {
    const auto set = links_.rows_.set(packet.first);
    Inverse& inverse = inverses_[set];
    const auto& normal = links_.rows_[packet.first].normal;
    if (inverse.x.empty() || inverse.normal != normal) {
      const glm::mat3 frame = frame_about(normal);
      inverse.set(normal, links_.rays(),
                  [&](std::uint32_t number) { return frame * links_.sets_[set][number]; });
    }
    // First whatever starts between the lowest and the highest place.
    enter<0, 1>(box_, links_.rays(), {&places.min.x, &places.min.y, &places.min.z},
                {&places.max.x, &places.max.y, &places.max.z}, inverse.all(), entries_.data());
    std::optional<Starts> starts;
    for (std::uint32_t number = 0; number < links_.rays(); ++number) {
      if (entries_[number] == infinite) continue;
      if (!starts) starts.emplace(links_.rows_, links_.sets_, packet, offset_, links_.index_.skin() / 2);
      look_along(*starts, packet, inverse, looking, number);
    }
  }

  void look_apart(const Rows::Packet& packet, std::uint32_t looking) {
    const Starts starts(links_.rows_, links_.sets_, packet, offset_, links_.index_.skin() / 2);
    for (std::uint32_t lane = 0; lane < starts.count; ++lane) {
      const glm::vec3 at = starts.place(lane);
      if (!(looking >> lane & 1) || !sees(starts.face(lane), {at - offset_, at - offset_})) continue;
      Inverse& inverse = inverses_[0];
      inverse.set(starts.face(lane), links_.rays(),
                  [&](std::uint32_t number) { return starts.direction(lane, number); });
      inverse.normal = glm::vec3(0);  // of one row alone
      const Coordinates place{&at.x, &at.y, &at.z};
      enter<0, 1>(box_, links_.rays(), place, place, inverse.all(), entries_.data());
      for (std::uint32_t number = 0; number < links_.rays(); ++number)
        if (entries_[number] < infinite)
          add(starts, packet, lane, number, starts.direction(lane, number), entries_[number]);
    }
  }

  void look_along(const Starts& starts, const Range& packet, const Inverse& inverse, std::uint32_t looking,
                  std::uint32_t number) {
    const Coordinates places{starts.x.data(), starts.y.data(), starts.z.data()};
    std::array<float, lanes> entries;
    enter<1, 0>(box_, starts.count, places, places,
                {&inverse.x[number], &inverse.y[number], &inverse.z[number]}, entries.data());
    const glm::vec3 direction = starts.direction(0, number);
    for (std::uint32_t lane = 0; lane < starts.count; ++lane)
      if (entries[lane] < infinite && (looking >> lane & 1))
        add(starts, packet, lane, number, direction, entries[lane]);
  }

  void add(const Starts& starts, const Range& packet, std::uint32_t lane, std::uint32_t number,
           const glm::vec3& direction, float entry) {
    const std::size_t ray = std::size_t{packet.first + lane} * links_.rays() + number;
    const float reach = links_.own_distance_[ray];
    if (entry >= reach || glm::dot(direction, starts.face(lane)) <= 0) return;
    along_.set(count_, starts.place(lane), direction);
    reach_[count_] = reach;
    ray_[count_] = ray;
    if (++count_ == lanes) trace();
  }

  const RayLinks& links_;
  const std::uint32_t body_;
  const glm::vec3 offset_;  // of the receivers
  const scene::Box box_;    // of the body, where it is [m]
  Covers& covers_;
  std::vector<Inverse> inverses_;  // of each set, about the normal that was looked at last
  std::vector<float> entries_;     // how far along each direction the box begins [m]
  scene::RayPacket along_;
  std::array<float, lanes> reach_;  // [m]
  std::array<std::size_t, lanes> ray_;
  std::uint32_t count_ = 0;
};

RayLinks::Covers RayLinks::find_covers(std::uint32_t body, std::uint32_t receiver) const {
  const auto packets = rows_.packets_of_body(receiver);
  const std::uint32_t tasks = (packets.size() + packets_of_a_search - 1) / packets_of_a_search;
  std::vector<Covers> of_task(tasks);
  for_each_index(0, tasks, 1, [&](std::uint32_t task) {
    const std::uint32_t first = packets.first + task * packets_of_a_search;
    Search search(*this, body, receiver, of_task[task]);
    for (auto packet = first; packet < std::min(first + packets_of_a_search, packets.end); ++packet)
      search.look(rows_.packets()[packet]);
    search.trace();
  });
  Covers all;
  for (const auto& some : of_task) all.insert(all.end(), some.begin(), some.end());
  return all;
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
