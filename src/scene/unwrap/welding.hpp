// What of a mesh hangs together: corners that coincide are one, whatever the file's vertices are.
#pragma once

#include <array>
#include <bit>
#include <boost/pending/disjoint_sets.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "triangle.hpp"

namespace lichtveld::scene {

// A hash of what came before and one more value.
inline std::size_t mixed(std::size_t seed, std::uint64_t value) {
  return seed ^ (value * 0x9e3779b97f4a7c15u + (seed << 6) + (seed >> 2));
}

// Numbers for things that are equal bit by bit (0 and -0 are one).
template <std::size_t size>
class Numbers {
 public:
  std::uint32_t of(std::array<float, size> key) {
    for (float& value : key) value += 0.0f;
    return known_.try_emplace(key, static_cast<std::uint32_t>(known_.size())).first->second;
  }

 private:
  struct Hash {
    std::size_t operator()(const std::array<float, size>& key) const {
      std::size_t seed = 0;
      for (const float value : key) seed = mixed(seed, std::bit_cast<std::uint32_t>(value));
      return seed;
    }
  };
  std::unordered_map<std::array<float, size>, std::uint32_t, Hash> known_;
};

using Places = std::array<std::uint32_t, 3>;  // a triangle's corners by number, alike where they coincide

std::vector<Places> welded(std::span<const Corners> triangles);

// The triangles along each edge, by its two ends in the order in which they run round the triangle.
class Edges {
 public:
  explicit Edges(std::span<const Places> places) {
    all_.reserve(3 * places.size());
    for (std::uint32_t t = 0; t < places.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) all_.emplace_back(key(places[t][k], places[t][(k + 1) % 3]), t);
    std::ranges::sort(all_);
  }

  template <typename Each>
  void for_triangles(std::uint32_t from, std::uint32_t to, const Each& each) const {
    const std::uint64_t wanted = key(from, to);
    for (auto at = std::ranges::lower_bound(all_, std::pair{wanted, std::uint32_t{0}});
         at != all_.end() && at->first == wanted; ++at)
      each(at->second);
  }

 private:
  static std::uint64_t key(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }
  std::vector<std::pair<std::uint64_t, std::uint32_t>> all_;
};

// Which triangles lie on each other with the same corners in the same order: each one's first such, itself for
// most, and by how many corners it is turned against that.
struct Twins {
  std::vector<std::uint32_t> first;
  std::vector<std::uint8_t> turn;
};

Twins find_twins(std::span<const Places> places);

using Sets = boost::disjoint_sets_with_storage<>;

// For each triangle the piece that it is of, where pieces hang together by edges, and whether each piece is
// closed: every edge runs both ways equally often.
struct Bodies {
  std::vector<std::uint32_t> of;
  std::vector<bool> closed;
  std::vector<double> volume;       // of each that is closed [m3], below 0 where it faces inwards
  std::vector<glm::vec3> min, max;  // of each [m]

  // Whether it is closed, and more space is inside than outside.
  bool is_solid(std::size_t body) const { return closed[body] && volume[body] > 0; }
};
Bodies find_bodies(std::span<const Corners> triangles, std::span<const Places> places);

}  // namespace lichtveld::scene
