// One path after another: light that arrives at a place.
#pragma once

#include <cstdint>
#include <optional>

#include "embree_scene.hpp"
#include "geometry.hpp"
#include "lamps.hpp"
#include "sampler.hpp"

namespace lichtveld::reference {

struct RayCount {
  std::uint64_t rays = 0, misses = 0;  // cosine-distributed ones from texels; those that hit nothing
};

class PathTracer {
 public:
  // The geometry must outlive it. Without `bounces`, paths end by chance.
  PathTracer(const Geometry& geometry, std::optional<std::uint32_t> bounces)
      : geometry_(geometry), lamps_(geometry), embree_(geometry), bounces_(bounces) {}

  // An estimate of E [W m^-2], right on average.
  glm::vec3 irradiance(Receiver at, Sampler& sampler, RayCount& count) const;

 private:
  glm::vec3 from_a_lamp(const Receiver& at, glm::dvec2 random) const;
  glm::vec3 from_lights(const Receiver& at, glm::dvec2 random) const;
  double lamp_density(const Receiver& at, const Hit& hit, const glm::vec3& direction) const;

  const Geometry& geometry_;
  const Lamps lamps_;
  const EmbreeScene embree_;
  const std::optional<std::uint32_t> bounces_;
};

}  // namespace lichtveld::reference
