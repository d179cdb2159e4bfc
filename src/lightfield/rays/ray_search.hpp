// Finds what rows see: each body's rows of what stands still and of their own body, and which of their rays
// meet another body on the way there.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lichtveld/lightfield/light_field.hpp"
#include "lichtveld/scene/ray_index.hpp"
#include "rays/ray_sets.hpp"
#include "rays/rows.hpp"

namespace lichtveld::lightfield {

// A ray that meets a body before it meets what stands still.
struct Cover {
  std::size_t ray;     // row * rays + its number
  std::uint32_t seen;  // as RayLinks::of
  float distance;      // [m]
};
using Covers = std::vector<Cover>;  // row by row

class RaySearch {
 public:
  // All of these must outlive it.
  RaySearch(const scene::RayIndex& index, const scene::Scene& scene, const Rows& rows, const RaySets& sets)
      : index_(index), scene_(scene), rows_(rows), sets_(sets) {}

  std::uint32_t rays() const { return sets_.rays(); }
  std::uint32_t nothing() const { return rows_.count(); }
  std::uint32_t outside() const { return rows_.count() + 1; }

  // What the rows of a packet see without other bodies: see RayLinks::of, distances and valid; all of all rows.
  void find_own(const Rows::Packet& packet, const scene::Offsets& offsets, std::span<std::uint32_t> seen,
                std::span<float> distances, std::span<std::array<std::uint32_t, 2>> valid) const;

  // The rays of the receivers' rows that meet a body nearer than `reach` says, for all rays of all rows [m].
  Covers find_covers(std::uint32_t body, std::uint32_t receivers, const scene::Offsets& offsets,
                     std::span<const float> reach) const;

 private:
  class Covering;
  std::uint32_t row_of(const scene::HitPacket& hits, std::size_t lane) const;
  bool contact(std::uint32_t row, std::uint32_t body, const scene::Offsets& offsets) const;

  const scene::RayIndex& index_;
  const scene::Scene& scene_;
  const Rows& rows_;
  const RaySets& sets_;
};

}  // namespace lichtveld::lightfield
