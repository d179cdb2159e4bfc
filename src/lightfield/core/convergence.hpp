// How much light a solve may still miss: a bound from the last bounce's change. And how far its answer may be
// off.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/texel_records.hpp"
#include "lichtveld/lightfield/light_field.hpp"

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

// Bounces until that bound (Solution::residual) is met, or falls no more, for rounding: true. `bounce` does one
// more and writes the solution's bounces and residual; after each that has not got there, `enough` may end it.
bool bounce_until_converged(const Solution& solution, const std::function<void()>& bounce,
                            const LightField::Enough& enough);

// That bound from whole light maps, of texels with a > 0, all channels.
class Convergence {
 public:
  explicit Convergence(const TexelRecords& records);

  // After a bounce that led to this E [W m^-2]; before the first it was 0.
  double measure(std::vector<glm::vec4>&& irradiance);

 private:
  std::vector<glm::vec4> before_;
  float albedo_max_;
};

// Solution::error_estimate: the root mean square of what the halves of the directions differ by from their
// mean, over the mean of E, over texels with a > 0 in `irradiance`, all channels.
double split_half_error(std::span<const glm::vec4> irradiance, std::span<const glm::vec4> half_difference);

}  // namespace lichtveld::lightfield
