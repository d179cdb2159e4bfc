#include "welding.hpp"

#include <algorithm>

namespace lichtveld::scene {

std::vector<Places> welded(std::span<const Corners> triangles) {
  Numbers<3> numbers;
  std::vector<Places> places(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      places[t][k] = numbers.of({triangles[t][k].x, triangles[t][k].y, triangles[t][k].z});
  return places;
}

Twins find_twins(std::span<const Places> places) {
  struct Hash {
    std::size_t operator()(const Places& key) const { return mixed(mixed(mixed(0, key[0]), key[1]), key[2]); }
  };
  Twins twins{std::vector<std::uint32_t>(places.size()), std::vector<std::uint8_t>(places.size())};
  std::unordered_map<Places, std::pair<std::uint32_t, std::uint8_t>, Hash> known;
  for (std::uint32_t t = 0; t < places.size(); ++t) {
    Places turned = places[t];
    const auto least = std::ranges::min_element(turned) - turned.begin();
    std::ranges::rotate(turned, turned.begin() + least);
    const auto [found, is_new] = known.try_emplace(turned, t, static_cast<std::uint8_t>(least));
    twins.first[t] = found->second.first;
    // Corner k of it is corner k + turn of the first.
    twins.turn[t] = static_cast<std::uint8_t>((found->second.second + 3 - least) % 3);
  }
  return twins;
}

Bodies find_bodies(std::span<const Corners> triangles, std::span<const Places> places) {
  Sets sets(3 * triangles.size());
  std::unordered_map<std::uint64_t, std::int64_t> balance;  // of an edge, by its ends
  for (const auto& corners : places)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = corners[k], b = corners[(k + 1) % 3];
      sets.union_set(corners[0], corners[k]);
      balance[std::min(a, b) << 32 | std::max(a, b)] += a < b ? 1 : a > b ? -1 : 0;
    }
  Bodies bodies;
  std::unordered_map<std::size_t, std::uint32_t> known;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto [found, is_new] =
        known.try_emplace(sets.find_set(places[t][0]), static_cast<std::uint32_t>(bodies.volume.size()));
    const auto body = found->second;
    if (is_new) {
      bodies.volume.push_back(0);
      bodies.closed.push_back(true);
      bodies.min.push_back(triangles[t][0]);
      bodies.max.push_back(triangles[t][0]);
    }
    bodies.of.push_back(body);
    bodies.volume[body] += glm::dot(glm::dvec3(triangles[t][0]), cross_of(triangles[t])) / 6;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = places[t][k], b = places[t][(k + 1) % 3];
      if (balance[std::min(a, b) << 32 | std::max(a, b)] != 0) bodies.closed[body] = false;
      bodies.min[body] = glm::min(bodies.min[body], triangles[t][k]);
      bodies.max[body] = glm::max(bodies.max[body], triangles[t][k]);
    }
  }
  return bodies;
}

}  // namespace lichtveld::scene
