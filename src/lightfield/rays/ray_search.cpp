#include "rays/ray_search.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "core/frame.hpp"
#include "core/parallel.hpp"
#include "lichtveld/scene/ray_queue.hpp"
#include "lichtveld/scene/slabs.hpp"

namespace lichtveld::lightfield {

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr std::uint32_t packets_of_a_task = 128;

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

}  // namespace

void RaySearch::find_own(const Rows::Packet& packet, const scene::Offsets& offsets,
                         std::span<std::uint32_t> seen, std::span<float> distances,
                         std::span<std::array<std::uint32_t, 2>> valid) const {
  const std::uint32_t body = rows_[packet.first].body;
  const Starts starts(rows_, sets_, packet, offsets[body], index_.skin() / 2);
  const bool meets_body = body != 0 && starts.meet_own_body(index_);
  std::uint32_t looking = 0;  // those that nothing lies on
  for (std::uint32_t lane = 0; lane < starts.count; ++lane) {
    const std::uint32_t row = packet.first + lane;
    valid[row] = {};
    if (!contact(row, 0, offsets) && (!meets_body || !contact(row, body, offsets))) looking |= 1u << lane;
  }
  scene::RayPacket along;
  scene::HitPacket hits;
  for (std::uint32_t number = 0; number < rays(); ++number) {
    starts.rays(number, along);
    const std::uint32_t leaving = std::exchange(along.lanes, along.lanes & looking);
    hits.clear(infinite);
    if (along.lanes != 0) index_.nearest(0, {}, along, hits);
    if (along.lanes != 0 && meets_body) index_.nearest(body, offsets[body], along, hits);
    for (std::uint32_t lane = 0; lane < starts.count; ++lane) {
      const std::size_t ray = std::size_t{packet.first + lane} * rays() + number;
      const bool leaves = leaving >> lane & 1, looks = looking >> lane & 1;
      valid[packet.first + lane][number < (rays() + 1) / 2 ? 0 : 1] += leaves;
      seen[ray] = !looks ? nothing() : leaves ? row_of(hits, lane) : outside();
      distances[ray] = looks ? hits.distance[lane] : 0.0f;
    }
  }
}

// As RayLinks::of says.
std::uint32_t RaySearch::row_of(const scene::HitPacket& hits, std::size_t lane) const {
  if (hits.triangle[lane] == scene::HitPacket::none) return nothing();
  const auto row =
      rows_.seen({hits.triangle[lane], {hits.u[lane], hits.v[lane]}}, hits.from_behind >> lane & 1);
  return row == no_row ? nothing() : row;
}

// Whether a body lies on a row.
bool RaySearch::contact(std::uint32_t row, std::uint32_t body, const scene::Offsets& offsets) const {
  const auto& record = rows_[row];
  return index_.contact(body, offsets[body], record.position + offsets[record.body], record.face,
                        record.triangle);
}

// Of the rays of rows those that may meet a body, whatever rows they start from, so that packets are full.
class RaySearch::Covering {
 public:
  Covering(const RaySearch& search, std::uint32_t body, std::uint32_t receivers, const scene::Offsets& offsets,
           std::span<const float> reach, Covers& covers)
      : search_(search),
        body_(body),
        offsets_(offsets),
        offset_(offsets[receivers]),
        box_(shifted(search.scene_.bodies[body].box, offsets[body], search.index_.skin())),
        reach_(reach),
        covers_(covers),
        inverses_(search.sets_.sets()),
        entries_(search.rays()) {}

  void look(const Rows::Packet& packet) {
    const scene::Box places = shifted(packet.box, offset_, 0);
    if (packet.alike && !sees(search_.rows_[packet.first].face, packet.box)) return;
    const std::uint32_t looking = looks_beside_contacts(packet, places);
    if (packet.alike)
      look_together(packet, places, looking);
    else
      look_apart(packet, looking);
  }

  // What is left in the queue.
  void finish() {
    queue_.flush([&](const auto& rays, auto of) { trace(rays, of); });
  }

 private:
  struct Of {
    std::size_t ray;
    float reach;  // [m]
  };

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
    scene::Coordinates all() const { return {x.data(), y.data(), z.data()}; }
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
      if (search_.contact(packet.first + lane, body_, offsets_)) {
        looking &= ~(1u << lane);
        for (std::uint32_t number = 0; number < search_.rays(); ++number)
          covers_.push_back({std::size_t{packet.first + lane} * search_.rays() + number, search_.nothing(), 0});
      }
    return looking;
  }

  void look_together(const Rows::Packet& packet, const scene::Box& places, std::uint32_t looking) {
    const auto set = search_.rows_.set(packet.first);
    Inverse& inverse = inverses_[set];
    const auto& normal = search_.rows_[packet.first].normal;
    if (inverse.x.empty() || inverse.normal != normal) {
      const glm::mat3 frame = frame_about(normal);
      inverse.set(normal, search_.rays(),
                  [&](std::uint32_t number) { return frame * search_.sets_[set][number]; });
    }
    // First whatever starts between the lowest and the highest place.
    scene::enter<0, 1>(box_, search_.rays(), {&places.min.x, &places.min.y, &places.min.z},
                       {&places.max.x, &places.max.y, &places.max.z}, inverse.all(), entries_.data());
    std::optional<Starts> starts;
    for (std::uint32_t number = 0; number < search_.rays(); ++number) {
      if (entries_[number] == infinite) continue;
      if (!starts) starts.emplace(search_.rows_, search_.sets_, packet, offset_, search_.index_.skin() / 2);
      look_along(*starts, packet, inverse, looking, number);
    }
  }

  void look_apart(const Rows::Packet& packet, std::uint32_t looking) {
    const Starts starts(search_.rows_, search_.sets_, packet, offset_, search_.index_.skin() / 2);
    for (std::uint32_t lane = 0; lane < starts.count; ++lane) {
      const glm::vec3 at = starts.place(lane);
      if (!(looking >> lane & 1) || !sees(starts.face(lane), {at - offset_, at - offset_})) continue;
      Inverse& inverse = inverses_[0];
      inverse.set(starts.face(lane), search_.rays(),
                  [&](std::uint32_t number) { return starts.direction(lane, number); });
      inverse.normal = glm::vec3(0);  // of one row alone
      const scene::Coordinates place{&at.x, &at.y, &at.z};
      scene::enter<0, 1>(box_, search_.rays(), place, place, inverse.all(), entries_.data());
      for (std::uint32_t number = 0; number < search_.rays(); ++number)
        if (entries_[number] < infinite)
          add(starts, packet, lane, number, starts.direction(lane, number), entries_[number]);
    }
  }

  void look_along(const Starts& starts, const Range& packet, const Inverse& inverse, std::uint32_t looking,
                  std::uint32_t number) {
    const scene::Coordinates places{starts.x.data(), starts.y.data(), starts.z.data()};
    std::array<float, Starts::most> entries;
    scene::enter<1, 0>(box_, starts.count, places, places,
                       {&inverse.x[number], &inverse.y[number], &inverse.z[number]}, entries.data());
    const glm::vec3 direction = starts.direction(0, number);
    for (std::uint32_t lane = 0; lane < starts.count; ++lane)
      if (entries[lane] < infinite && (looking >> lane & 1))
        add(starts, packet, lane, number, direction, entries[lane]);
  }

  void add(const Starts& starts, const Range& packet, std::uint32_t lane, std::uint32_t number,
           const glm::vec3& direction, float entry) {
    const std::size_t ray = std::size_t{packet.first + lane} * search_.rays() + number;
    const float reach = reach_[ray];
    if (entry >= reach || glm::dot(direction, starts.face(lane)) <= 0) return;
    queue_.add(starts.place(lane), direction, {ray, reach},
               [&](const auto& rays, auto of) { trace(rays, of); });
  }

  void trace(const scene::RayPacket& rays, std::span<const Of> of) {
    scene::HitPacket hits;
    hits.clear(0);
    for (std::size_t lane = 0; lane < of.size(); ++lane) hits.distance[lane] = of[lane].reach;
    search_.index_.nearest(body_, offsets_[body_], rays, hits);
    for (std::size_t lane = 0; lane < of.size(); ++lane)
      if (hits.triangle[lane] != scene::HitPacket::none)
        covers_.push_back({of[lane].ray, search_.row_of(hits, lane), hits.distance[lane]});
  }

  const RaySearch& search_;
  const std::uint32_t body_;
  const scene::Offsets& offsets_;
  const glm::vec3 offset_;  // of the receivers
  const scene::Box box_;    // of the body, where it is [m]
  const std::span<const float> reach_;
  Covers& covers_;
  std::vector<Inverse> inverses_;  // of each set, about the normal that was looked at last
  std::vector<float> entries_;     // how far along each direction the box begins [m]
  scene::RayQueue<Of> queue_;
};

Covers RaySearch::find_covers(std::uint32_t body, std::uint32_t receivers, const scene::Offsets& offsets,
                              std::span<const float> reach) const {
  const auto packets = rows_.packets_of_body(receivers);
  const std::uint32_t tasks = (packets.size() + packets_of_a_task - 1) / packets_of_a_task;
  std::vector<Covers> of_task(tasks);
  for_each_index(0, tasks, 1, [&](std::uint32_t task) {
    const std::uint32_t first = packets.first + task * packets_of_a_task;
    Covering search(*this, body, receivers, offsets, reach, of_task[task]);
    for (auto packet = first; packet < std::min(first + packets_of_a_task, packets.end); ++packet)
      search.look(rows_.packets()[packet]);
    search.finish();
  });
  Covers all;
  for (const auto& some : of_task) all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace lichtveld::lightfield
