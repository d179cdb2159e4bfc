// The directions of the light field: a subdivided octahedron, each direction with the solid angle it stands
// for.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace lichtveld::lightfield {

struct Direction {
  glm::vec3 along;    // unit: the direction the light travels
  float solid_angle;  // [sr]; all of a set's sum to 4 pi
};

// The counts there are: 8 * 4^d (a triangle's centroid each) and 24 * 4^d (three interior points a triangle),
// from 8 to 6144, ascending.
std::span<const std::uint32_t> direction_counts();

// "8, 24, 32, ..": for messages.
std::string direction_counts_text();

// The set of `count` directions. The second half are the antipodes of the first: direction count / 2 + i is
// exactly minus direction i, with the same solid angle. Throws std::invalid_argument that lists the counts for
// any other.
std::vector<Direction> directions(std::uint32_t count);

}  // namespace lichtveld::lightfield
