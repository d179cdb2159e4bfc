// The directions that receivers look along: sets that share the hemisphere out among neighbouring texels
// (Keller and Heidrich 2001, "Interleaved Sampling"; the thesis' 4.8.2).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lichtveld::lightfield {

// `sets` sets of `rays` unit vectors about (0, 0, 1), cosine-distributed, so that each stands for as much of
// the irradiance. The points of all sets together are as evenly spread as those of one. The first half of a
// set's rays and the second are turned at random, each by itself, and so tell the error of their mean. Rays of
// the same number look nearly the same way in all sets.
class RaySets {
 public:
  RaySets(std::uint32_t rays, std::uint32_t sets, std::uint64_t seed);

  std::uint32_t rays() const { return rays_; }
  std::uint32_t sets() const { return static_cast<std::uint32_t>(directions_.size() / rays_); }
  std::span<const glm::vec3> operator[](std::uint32_t set) const {
    return std::span(directions_).subspan(std::size_t{set} * rays_, rays_);
  }

 private:
  std::uint32_t rays_;
  std::vector<glm::vec3> directions_;
};

}  // namespace lichtveld::lightfield
