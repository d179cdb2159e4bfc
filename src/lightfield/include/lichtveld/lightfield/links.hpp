// --method links: for every pair of directions and every texel the texel that it sees is found once and kept. A
// bounce is a sum over kept links; a moved body re-routes only what its old and its new projections touch.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "lichtveld/gpu/frame.hpp"
#include "lichtveld/lightfield/settings.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

// Kept links against those of a fresh build with the bodies where they are.
struct LinkCheck {
  std::uint64_t links = 0, differing = 0;      // looked at; of these, those that see another place
  std::uint64_t misses = 0, rays_unknown = 0;  // of the links looked at, as in Solution
};

class Links {
 public:
  // The device and the scene must outlive it. Throws std::invalid_argument for settings out of their ranges and
  // std::runtime_error, before anything large is allocated, if the links do not fit into the device's memory.
  Links(const gpu::Device& device, const scene::Scene& scene, const Settings& settings);
  ~Links();

  // Computes E with body i shifted by offsets[i] [m]; offsets has one entry a body. What is known from before
  // is kept: links that no moved body touched, and with `--bounces auto` the light to start from.
  Solution solve(const std::vector<glm::vec3>& offsets);

  // The same for the next frame of a room where things move: re-routes, then bounces from the light as it is,
  // at least one, until nothing is missing or enough(bounces so far) is true. Solution::residual says what may
  // be missing; error_estimate is left out. Where nothing has moved and nothing is missing, nothing is done and
  // bounces is 0.
  Solution update(const std::vector<glm::vec3>& offsets, const std::function<bool(std::uint32_t)>& enough);

  // Routes up to `pairs` pairs of directions again, in full, and compares: those that have not been looked at
  // since the last move. Nothing once all have, or before the first solve() or update(). None is expected to differ. (A
  // pixel's centre on the border of two texels may see either.)
  LinkCheck check(std::uint32_t pairs);

  // After either. size * size texels, row 0 on top.
  std::vector<glm::vec4> irradiance();    // rgb: E [W m^-2]; a: 1 on valid texels
  std::vector<std::uint8_t> presented();  // tone-mapped L, sRGB RGBA, gutters dilated

  // What the passes have cost since the start, by name.
  const gpu::PassTimes& times() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace lichtveld::lightfield
