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

// The set of `count` directions: the octahedron's 8 * 4^d triangles, or 24 * 4^d thirds of triangles, joined in
// neighbouring pairs give count / 2 cells, and the directions are the cells' middles in two such sets, each
// rotated at random by `seed`. Joined cells are rounder than thirds; and because the two sets know nothing of
// each other, how far their answers differ tells how far their mean is off (Solution::error_estimate).
// Direction count / 2 + i is exactly minus direction i, of the same half, with the same solid angle and raster.
// Throws std::invalid_argument that lists the counts for any other.
std::vector<Direction> directions(std::uint32_t count, Weights weights = Weights::solid_angle,
                                  std::uint64_t seed = 0);

}  // namespace lichtveld::lightfield
