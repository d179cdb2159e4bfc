#include "core/buried.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "core/frame.hpp"
#include "core/parallel.hpp"
#include "lichtveld/scene/atlas.hpp"

namespace lichtveld::lightfield {

namespace {

constexpr std::uint32_t rays = scene::RayPacket::size;
// Of these rays at most so many may meet a front, through a crack, and at least so many meet backs.
constexpr int most_fronts = 1, least_backs = 2;

constexpr int reach = 2;  // texels that light is taken from
// Texels beside each other in the atlas are so on their surface, too, if their normals are within this and they
// are no farther apart [sides].
constexpr float crease_cosine = 0.95f, most_apart = 3;

// About +z, as many along each as it counts for irradiance (a Fibonacci lattice).
std::array<glm::vec3, rays> cosine_directions() {
  std::array<glm::vec3, rays> directions;
  for (std::uint32_t i = 0; i < rays; ++i) {
    const float share = (static_cast<float>(i) + 0.5f) / static_cast<float>(rays), radius = std::sqrt(share),
                turn = 2 * std::numbers::pi_v<float> * std::numbers::phi_v<float> * static_cast<float>(i);
    directions[i] = {radius * std::cos(turn), radius * std::sin(turn), std::sqrt(1 - share)};
  }
  return directions;
}

class Looking {
 public:
  Looking(const scene::RayIndex& index, const scene::Scene& scene)
      : index_(index), sky_(scene.sky.has_value()), directions_(cosine_directions()) {}

  // `places` are at most as many as a packet's rays; a bit for each that may be, by what is straight above it.
  std::uint32_t candidates(std::span<const TexelRecord> places) const {
    scene::RayPacket along;
    for (std::uint32_t lane = 0; lane < rays; ++lane) {
      const auto& place = places[std::min<std::size_t>(lane, places.size() - 1)];
      along.set(lane, start(place), place.face);
    }
    along.lanes = (1u << places.size()) - 1;
    const auto met = index_.sides_met(0, {}, along);
    return sky_ ? met.backs : along.lanes & ~met.fronts;
  }

  bool is_buried(const TexelRecord& place) const {
    scene::RayPacket around;
    const glm::mat3 frame = frame_about(place.face);
    for (std::uint32_t lane = 0; lane < rays; ++lane) around.set(lane, start(place), frame * directions_[lane]);
    around.lanes = (1u << rays) - 1;
    const auto met = index_.sides_met(0, {}, around);
    const int fronts = std::popcount(met.fronts), backs = std::popcount(met.backs);
    return fronts <= most_fronts && backs >= (sky_ ? static_cast<int>(rays) - most_fronts : least_backs);
  }

 private:
  glm::vec3 start(const TexelRecord& place) const { return place.position + index_.skin() / 2 * place.face; }

  const scene::RayIndex& index_;
  bool sky_;
  std::array<glm::vec3, rays> directions_;
};

}  // namespace

std::vector<char> find_buried(const scene::RayIndex& index, const scene::Scene& scene,
                              std::span<const TexelRecord> places) {
  std::vector<char> buried(places.size());
  const Looking looking(index, scene);
  const auto tasks = static_cast<std::uint32_t>((places.size() + rays - 1) / rays);
  for_each_index(0, tasks, 64, [&](std::uint32_t task) {
    const std::size_t first = std::size_t{task} * rays;
    const auto some = places.subspan(first, std::min<std::size_t>(rays, places.size() - first));
    const auto candidates = looking.candidates(some);
    for (std::size_t i = 0; i < some.size(); ++i)
      buried[first + i] = some[i].body == 0 && (candidates >> i & 1) && looking.is_buried(some[i]);
  });
  return buried;
}

// Not TexelRecords: what texels reflect and send is of no use here, and of textures it takes long.
BuriedTexels::BuriedTexels(const scene::Scene& scene, std::uint32_t size) {
  const auto surfaces = surface_of_triangles(scene);
  std::vector<TexelRecord> records;
  for (const auto& [texel, at] : scene::valid_texels(scene, size))
    records.push_back(record_at(scene, size, at, surfaces[at.triangle], texel));
  const scene::RayIndex index(scene);
  auto hidden = find_buried(index, scene, records);
  std::vector<std::uint32_t> number(std::size_t{size} * size, no_record), waiting;
  for (std::uint32_t i = 0; i < records.size(); ++i) {
    number[records[i].atlas] = i;
    if (!hidden[i]) continue;
    // What something lies on gets no light, and that is right.
    const auto& record = records[i];
    if (index.contact(0, {}, record.position, record.face, record.triangle)) continue;
    waiting.push_back(i);
  }
  count_ = static_cast<std::uint32_t>(waiting.size());
  const auto beside = [&](const TexelRecord& a, const TexelRecord& b) {
    return a.surface == b.surface && glm::dot(a.normal, b.normal) > crease_cosine &&
           glm::distance(a.position, b.position) < most_apart * std::max(a.side, b.side);
  };
  for (int ring = 0; ring < reach; ++ring) {
    std::vector<std::uint32_t> left, lit;
    for (const auto i : waiting) {
      const auto& own = records[i];
      const auto before = from_.size();
      const std::uint32_t x = own.atlas % size, y = own.atlas / size;
      for (std::uint32_t v = y - (y > 0); v <= std::min(y + 1, size - 1); ++v)
        for (std::uint32_t u = x - (x > 0); u <= std::min(x + 1, size - 1); ++u) {
          const auto other = number[std::size_t{v} * size + u];
          if (other != no_record && !hidden[other] && beside(own, records[other]))
            from_.push_back(records[other].atlas);
        }
      if (from_.size() == before) {
        left.push_back(i);
        continue;
      }
      takings_.push_back({own.atlas, static_cast<std::uint32_t>(from_.size())});
      lit.push_back(i);
    }
    for (const auto i : lit) hidden[i] = 0;
    waiting = std::move(left);
  }
}

void BuriedTexels::take_light_of_neighbours(std::span<glm::vec4> irradiance) const {
  std::uint32_t first = 0;
  for (const auto& [texel, end] : takings_) {
    glm::vec3 sum(0);
    for (auto i = first; i < end; ++i) sum += glm::vec3(irradiance[from_[i]]);
    irradiance[texel] = glm::vec4(sum / static_cast<float>(end - first), irradiance[texel].a);
    first = end;
  }
}

}  // namespace lichtveld::lightfield
