// How much light a solve may still miss: a bound from the last bounce's change.
#pragma once

#include "lichtveld/lightfield/settings.hpp"
#include "passes/light_map.hpp"

namespace lichtveld::lightfield {

// Where a bound of `auto` cannot be met (an albedo of 1 bounds nothing), it ends here.
constexpr std::uint32_t most_bounces = 256;
// `auto` ends when the bound on what is missing falls below this share of the mean.
constexpr double converged = 1e-3;

// Says in the log that most_bounces were not enough.
void warn_of_no_bound(const Solution& solution);

// A bounce multiplies what is missing by at most the largest albedo, because the rows of the transport operator
// sum to one. After a bounce that changed E by at most `change`, what all later bounces still add is below
// change / (1 - max albedo): that bound as a share of E's mean, infinite if an albedo is 1.
double bound_on_missing(double change, float albedo_max, double mean);

class Convergence {
 public:
  // Reads the largest albedo and the valid texels of a map whose geometry_texture is drawn.
  Convergence(const gpu::Device& device, const LightMap& map);

  std::uint32_t texels_valid() const { return texels_valid_; }

  // After a bounce: that bound, over the valid texels and channels.
  double measure(const gpu::Device& device, const LightMap& map);

 private:
  std::vector<glm::vec4> before_;
  std::uint32_t texels_valid_ = 0;
  float albedo_max_ = 0;
};

// Solution::error_estimate of the last bounce: the root mean square of half_difference over the mean of E, over
// the valid texels and channels.
double split_half_error(const gpu::Device& device, const LightMap& map);

}  // namespace lichtveld::lightfield
