// A light map as a list of texels that know where they lie and what area they stand for.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::testing {

struct Texel {
  std::string node;
  glm::dvec3 position;        // [m], bodies at rest
  double area;                // that it stands for [m^2]
  glm::dvec3 irradiance;      // [W m^-2]
  double standard_error = 0;  // of the mean of E's channels [W m^-2]; 0 where a method has none
};
using Texels = std::vector<Texel>;

// The valid texels (alpha > 0) of a map of size * size; `errors` may be empty.
inline Texels texels(const scene::Scene& scene, std::uint32_t size, std::span<const glm::vec4> map,
                     std::span<const float> errors) {
  Texels result;
  std::vector<bool> found(map.size());
  // A centre on a triangle's edge belongs to one of two neighbours, and it does not matter here to which.
  constexpr double on_edge = 1e-6;
  for (const auto& surface : scene.surfaces)
    for (std::uint32_t i = surface.first_index; i < surface.first_index + surface.index_count; i += 3) {
      const auto corner = [&](std::uint32_t k) -> const scene::Vertex& {
        return scene.vertices[scene.indices[i + k]];
      };
      const double n = size;
      const glm::dvec2 a = glm::dvec2(corner(0).atlas) * n - 0.5,
                       ab = glm::dvec2(corner(1).atlas) * n - 0.5 - a,
                       ac = glm::dvec2(corner(2).atlas) * n - 0.5 - a;
      const glm::dvec3 p = corner(0).position, pq = glm::dvec3(corner(1).position) - p,
                       pr = glm::dvec3(corner(2).position) - p;
      const double chart = ab.x * ac.y - ab.y * ac.x;  // twice its area in texels
      if (chart == 0) continue;
      const glm::dvec2 low = glm::min(a, glm::min(a + ab, a + ac)),
                       high = glm::max(a, glm::max(a + ab, a + ac));
      for (auto y = std::max<std::int64_t>(std::llround(low.y), 0); y <= std::min(high.y + 1, n - 1); ++y)
        for (auto x = std::max<std::int64_t>(std::llround(low.x), 0); x <= std::min(high.x + 1, n - 1); ++x) {
          const auto index = static_cast<std::size_t>(y * size + x);
          const glm::dvec2 at = glm::dvec2(x, y) - a;
          const double s = (at.x * ac.y - at.y * ac.x) / chart, t = (ab.x * at.y - ab.y * at.x) / chart;
          if (found[index] || map[index].a == 0 || std::min({s, t, 1 - s - t}) < -on_edge) continue;
          found[index] = true;
          result.push_back({surface.node, p + s * pq + t * pr,
                            glm::length(glm::cross(pq, pr)) / std::abs(chart), glm::dvec3(map[index]),
                            errors.empty() ? 0 : double{errors[index]}});
        }
    }
  return result;
}

inline Texels where(const Texels& all, const std::function<bool(const Texel&)>& wanted) {
  Texels result;
  std::ranges::copy_if(all, std::back_inserter(result), wanted);
  if (result.empty()) throw std::logic_error("a case that measures no texel at all");
  return result;
}

inline Texels of(const Texels& all, const std::string& node) {
  return where(all, [&](const Texel& texel) { return texel.node == node; });
}

using Exact = std::function<double(const Texel&)>;  // [W m^-2]

// E's mean over the area, of one channel.
inline double mean(const Texels& texels, int channel = 1) {
  double sum = 0, area = 0;
  for (const auto& texel : texels) {
    sum += texel.area * texel.irradiance[channel];
    area += texel.area;
  }
  return sum / area;
}

inline double mean(const Texels& texels, const Exact& exact) {
  double sum = 0, area = 0;
  for (const auto& texel : texels) {
    sum += texel.area * exact(texel);
    area += texel.area;
  }
  return sum / area;
}

inline double most(const Texels& texels, int channel = 1) {
  double result = 0;
  for (const auto& texel : texels) result = std::max(result, texel.irradiance[channel]);
  return result;
}

// A method's own noise is taken off before its errors are judged: where it owns up to one, a texel is wrong by
// what goes beyond four standard errors (which chance exceeds in one texel of a thousand, as 16 batches tell
// the error).
inline double beyond_noise(const Texel& texel, double exact) {
  return std::max(std::abs(texel.irradiance.g - exact) - 4 * texel.standard_error, 0.0);
}

// The share of texels that are more than `off` (relative) from exact.
inline double share_off(const Texels& texels, const Exact& exact, double off) {
  const auto wrong = std::ranges::count_if(
      texels, [&](const Texel& texel) { return !(beyond_noise(texel, exact(texel)) <= off * exact(texel)); });
  return static_cast<double>(wrong) / static_cast<double>(texels.size());
}

// The root of the mean squared error over the exact mean, over texels. Noise adds its variance, which is taken
// off.
inline double rel_rmse(const Texels& texels, const Exact& exact) {
  double squares = 0, sum = 0;
  for (const auto& texel : texels) {
    squares += std::pow(texel.irradiance.g - exact(texel), 2) - std::pow(texel.standard_error, 2);
    sum += exact(texel);
  }
  const auto n = static_cast<double>(texels.size());
  return std::sqrt(std::max(squares / n, 0.0)) / (sum / n);
}

}  // namespace lichtveld::testing
