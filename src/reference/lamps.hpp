// Chooses points on what glows, with a density that is proportional to their radiance.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry.hpp"

namespace lichtveld::reference {

class Lamps {
 public:
  // The geometry must outlive it.
  explicit Lamps(const Geometry& geometry);

  bool none() const { return triangles_.empty(); }

  // A point on a lamp, uniform in power: a triangle by area times radiance, then evenly over it. Not if none().
  // `random` is uniform in [0, 1)^2.
  Hit sample(glm::dvec2 random) const;

  // The density of sample() at any point of a triangle, per unit of area.
  double density(std::uint32_t triangle) const;

 private:
  const Geometry& geometry_;
  std::vector<std::uint32_t> triangles_;
  std::vector<double> power_up_to_;  // area * mean radiance, of a triangle and all before it
};

}  // namespace lichtveld::reference
