// How far a light map is from the truth, as the project reports it: in linear light, over the truth's valid
// texels, channels together, as shares of the truth's mean.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "lichtveld/reference/path_tracer.hpp"

namespace lichtveld::reference {

// All are NaN where the truth is dark, for then there is no mean to take a share of.
struct Error {
  double rel_rmse;  // sqrt(mean((E - Etruth)^2)) / mean(Etruth)
  double rel_p99;   // |E - Etruth| / mean(Etruth) that 99 % of the values do not exceed
  double rel_max;   // the largest
  double bias;      // mean(E - Etruth) / mean(Etruth), signed
};

// Both have the same number of texels; alpha > 0 marks the valid ones. Throws std::invalid_argument if they
// have not.
Error error_of(std::span<const glm::vec4> irradiance, std::span<const glm::vec4> truth);

// Its own noise: the root of the mean squared standard error over the valid texels, as a share of E's mean.
// That is the rel_rmse of a traced map against the exact answer that has to be expected.
double expected_rel_rmse(const Irradiance& traced);

}  // namespace lichtveld::reference
