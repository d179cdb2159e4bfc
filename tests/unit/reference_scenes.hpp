// Scenes for the reference whose answers are known, and what a trace says about them.
#pragma once

#include <cmath>
#include <numbers>

#include "lichtveld/reference/path_tracer.hpp"
#include "scene_builder.hpp"

namespace lichtveld::testing {

constexpr double pi = std::numbers::pi;

inline scene::Scene loaded(const SceneBuilder& builder) {
  const TempFolder folder;
  return scene::load(folder.write("scene.glb", builder.glb()));
}

// A closed box [-1, 1]^3 whose walls all emit `emission` and reflect `albedo`.
inline scene::Scene furnace(float albedo, float emission = 1) {
  SceneBuilder builder;
  builder.box("room", glm::vec3(-1), glm::vec3(1), {0, 0, 1, 1},
              builder.material(glm::vec3(albedo), glm::vec3(emission)), true);
  return loaded(builder);
}

// A horizontal square of side 2 * `half` about (x, y, 0).
inline int square(SceneBuilder& builder, const char* name, float y, bool down, Chart chart, int material,
                  float half = 1, float x = 0) {
  const float l = x - half, r = x + half, h = half;
  if (down) return builder.quad(name, {glm::vec3(l, y, -h), {r, y, -h}, {r, y, h}, {l, y, h}}, chart, material);
  return builder.quad(name, {glm::vec3(l, y, h), {r, y, h}, {r, y, -h}, {l, y, -h}}, chart, material);
}

// Charts whose edges lie between texels at sizes that 16 divides: the mean over texels is the midpoint rule.
constexpr Chart chart_a{1.f / 16, 1.f / 16, 7.f / 16, 7.f / 16},
    chart_b{9.f / 16, 1.f / 16, 15.f / 16, 7.f / 16}, chart_c{1.f / 16, 9.f / 16, 7.f / 16, 15.f / 16},
    chart_d{9.f / 16, 9.f / 16, 15.f / 16, 15.f / 16};
constexpr Chart whole_atlas{0, 0, 1, 1};

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
