// What a trace by the reference says about a scene whose answer is known.
#pragma once

#include <cmath>

#include "known_scenes.hpp"
#include "lichtveld/reference/path_tracer.hpp"

namespace lichtveld::testing {

struct Traced {
  reference::Irradiance light;
  std::uint32_t size;

  // Calls f(u, v, E, standard error of E's channel mean) for each valid texel of a chart.
  template <typename F>
  void each(Chart chart, const F& f) const {
    for (std::uint32_t texel = 0; texel < light.texels.size(); ++texel) {
      const float u = (static_cast<float>(texel % size) + 0.5f) / static_cast<float>(size),
                  v = (static_cast<float>(texel / size) + 0.5f) / static_cast<float>(size);
      if (light.texels[texel].a == 0 || u < chart.u0 || u > chart.u1 || v < chart.v0 || v > chart.v1) continue;
      f(u, v, glm::vec3(light.texels[texel]), double{light.standard_error[texel]});
    }
  }

  struct Mean {
    double value = 0, standard_error = 0;
  };
  // Of E's green over a chart; grey light is assumed for its error.
  Mean mean(Chart chart) const {
    Mean result;
    double texels = 0, squares = 0;
    each(chart, [&](float, float, const glm::vec3& irradiance, double error) {
      result.value += irradiance.g;
      squares += error * error;
      ++texels;
    });
    return {result.value / texels, std::sqrt(squares) / texels};
  }

  // The mean over a chart of ((E - exact(u, v)) / standard error)^2, for grey light: 15/13 if the errors are
  // honest, since each is itself estimated with 15 degrees of freedom.
  template <typename F>
  double squared_deviations(Chart chart, const F& exact) const {
    double sum = 0, texels = 0;
    each(chart, [&](float u, float v, const glm::vec3& irradiance, double error) {
      sum += std::pow((irradiance.g - exact(u, v)) / error, 2);
      ++texels;
    });
    return sum / texels;
  }
};

inline Traced traced(const scene::Scene& scene, const reference::Settings& settings,
                     const std::vector<glm::vec3>& offsets = {}) {
  return {reference::trace(scene, offsets, settings), settings.size};
}

}  // namespace lichtveld::testing
