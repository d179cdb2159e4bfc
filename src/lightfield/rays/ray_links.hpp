// What each row sees along each of its rays. What stands still is found once and kept; each body keeps a list
// of the rays that it covers, and a link is the nearest of all. A move redoes the lists of the body that moved,
// and its own rays. Nothing accumulates: links are the same as if they had been found afresh.
#pragma once

#include <array>
#include <boost/container/vector.hpp>
#include <cstdint>
#include <span>
#include <vector>

#include "lichtveld/lightfield/light_field.hpp"
#include "lichtveld/scene/ray_index.hpp"
#include "rays/ray_search.hpp"

namespace lichtveld::lightfield {

class RayLinks {
 public:
  static constexpr std::uint64_t bytes_a_ray = 16;  // two rows, two distances

  // All of these but `hidden` must outlive it: 1 for rows that are buried wherever bodies are.
  RayLinks(const scene::RayIndex& index, const scene::Scene& scene, const Rows& rows, const RaySets& sets,
           std::vector<char> hidden);

  // Bodies are where `offsets` say; `moves`: since the last time.
  void link(const scene::Offsets& offsets, const Moves& moves);

  // Row by row, rays() each: the row that is seen, nothing() where none is, or outside() for rays that would
  // leave below the row's own face and are none.
  std::span<const std::uint32_t> of(std::uint32_t row) const {
    return {seen_.data() + std::size_t{row} * rays(), rays()};
  }
  // How far away that is [m]; infinite where nothing is.
  std::span<const float> distances(std::uint32_t row) const {
    return {distance_.data() + std::size_t{row} * rays(), rays()};
  }
  // How many of the first and of the second half of the rays there are, without those that are none.
  const std::array<std::uint32_t, 2>& valid(std::uint32_t row) const { return valid_[row]; }
  // Of these, those that meet nothing.
  std::uint32_t misses(std::uint32_t row) const { return misses_[row]; }
  std::uint32_t rays() const { return search_.rays(); }
  std::uint32_t nothing() const { return search_.nothing(); }
  std::uint32_t outside() const { return search_.outside(); }

  // The rows of which a link has changed with the last move, ascending.
  const std::vector<std::uint32_t>& changed() const { return changed_; }
  // Whether something lies on the row or around it, by the middle of its texel: whoever sees it sees a part
  // beside that.
  bool buried(std::uint32_t row) const { return buried_[row] != 0; }

 private:
  // Whether something lies on the row without a gap, so that nothing at all arrives.
  bool covered(std::uint32_t row) const { return distances(row).front() == 0; }
  void find_own(std::uint32_t body);
  void uncover(const Covers& covers);
  void cover(const Covers& covers, bool anew);

  const Rows& rows_;
  const RaySearch search_;
  scene::Offsets offsets_;
  // Left as memory is until they are found: of millions of rays each pass over them counts.
  template <typename T>
  using OfRays = boost::container::vector<T>;
  OfRays<std::uint32_t> own_, seen_;         // without bodies but the row's own, and with all
  OfRays<float> own_distance_, distance_;    // [m]
  std::vector<std::vector<Covers>> covers_;  // by body, then by the rows' body
  // Rays that a body covered before this move and that have been set free; a bit for each of all, and which.
  std::vector<bool> reset_;
  std::vector<std::size_t> uncovered_;
  std::vector<std::array<std::uint32_t, 2>> valid_;
  std::vector<char> hidden_, buried_;
  std::vector<std::uint32_t> misses_;
  std::vector<char> touched_;  // rows of which a link has changed
  std::vector<std::uint32_t> changed_;
};

}  // namespace lichtveld::lightfield
