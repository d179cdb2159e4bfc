// The directions of the light field: subdivided octahedra, each direction with the solid angle it stands for.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "lichtveld/lightfield/settings.hpp"

namespace lichtveld::lightfield {

struct Direction {
  glm::vec3 along;     // unit: the direction the light travels
  float solid_angle;   // [sr]; all of a set's sum to 4 pi
  std::uint32_t half;  // 0 or 1: which of the two rotated sets it belongs to
  // Where its raster lies: turned about `along` [rad] and shifted [pixels, -0.5..0.5], so that edges fall
  // differently on every direction's pixels and aliasing averages out.
  float roll;
  glm::vec2 jitter;
};

// The counts there are: 8 * 4^d (a triangle's centroid each) and 24 * 4^d (three interior points a triangle),
// from 8 to 6144, ascending.
std::span<const std::uint32_t> direction_counts();

// "8, 24, 32, ..": for messages.
std::string direction_counts_text();

// Consecutive members of a list: first .. end - 1.
struct Range {
  std::uint32_t first, end;

  std::uint32_t size() const { return end - first; }
  bool operator==(const Range&) const = default;
};

// The octahedron's 8 * 4^d triangles, or 24 * 4^d thirds of triangles, joined in neighbouring pairs give count
// / 2 cells, and the directions are the cells' middles in two such sets, each rotated at random by `seed`.
// Joined cells are rounder than thirds; and because the two sets know nothing of each other, how far their
// answers differ tells how far their mean is off (Solution::error_estimate).
class DirectionSet {
 public:
  // Throws std::invalid_argument that lists the counts for any other.
  explicit DirectionSet(std::uint32_t count, Weights weights = Weights::solid_angle, std::uint64_t seed = 0);

  // Direction size() / 2 + i is exactly minus direction i, of the same half, with the same solid angle and
  // raster.
  std::uint32_t size() const { return static_cast<std::uint32_t>(all_.size()); }
  const Direction& operator[](std::uint32_t index) const { return all_[index]; }
  auto begin() const { return all_.begin(); }
  auto end() const { return all_.end(); }

  // Antipodal pairs: one direction of each. They stand half by half, each half part by part, so that the sums
  // of any ranges, wherever they were computed, add up to a bounce's.
  std::span<const Direction> pairs() const { return pairs_; }
  Range half(std::uint32_t index) const;  // 0 or 1, of the pairs

  // Of the pairs: a share of either half that spans the sphere by itself, what a bounce may leave for the next.
  // The first half of the parts is of half 0. With few directions some are empty.
  static constexpr std::uint32_t parts = 8;
  Range part(std::uint32_t index) const;

 private:
  std::vector<Direction> all_, pairs_;
};

}  // namespace lichtveld::lightfield
