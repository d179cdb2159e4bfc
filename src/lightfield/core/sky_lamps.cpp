#include "core/sky_lamps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "lichtveld/scene/lights.hpp"

namespace lichtveld::lightfield {

namespace {

// A sample stands for about so much of the sky: its radiance is looked up in pixels of that size, a half of
// this many columns high.
constexpr std::uint32_t sample_columns = 80;

// An octahedron, each of whose faces is four triangles: they cover the sphere, seen from inside.
std::vector<LampPatch> sky_patches(const scene::Sphere& around) {
  std::vector<LampPatch> patches;
  for (const float x : {-1.0f, 1.0f})
    for (const float y : {-1.0f, 1.0f})
      for (const float z : {-1.0f, 1.0f}) {
        const std::array corners = {glm::vec3(x, 0, 0), glm::vec3(0, y, 0), glm::vec3(0, 0, z)};
        const auto middle = [&](std::size_t i, std::size_t k) {
          return glm::normalize(corners[i] + corners[k]);
        };
        const std::array middles = {middle(1, 2), middle(2, 0), middle(0, 1)};
        for (const auto& [a, b, c] : {std::array{corners[0], middles[2], middles[1]},
                                      {corners[1], middles[0], middles[2]},
                                      {corners[2], middles[1], middles[0]},
                                      middles}) {
          const float size = far_away * around.radius;
          const bool inward = glm::dot(glm::cross(b - a, c - a), a) < 0;
          patches.push_back({.corner = around.centre + size * a,
                             .u = size * ((inward ? b : c) - a),
                             .v = size * ((inward ? c : b) - a),
                             .emission = glm::vec3(1),
                             .triangle = true,
                             .double_sided = false});
        }
      }
  return patches;
}

// Whether a direction from `eye` passes through a patch.
bool meets(const LampPatch& patch, const glm::vec3& eye, const glm::vec3& direction) {
  const glm::vec3 a = patch.corner - eye, b = a + patch.u, c = a + patch.v;
  const auto inside = [&](const glm::vec3& p, const glm::vec3& q) {
    return glm::dot(glm::cross(p, q), direction) <= 0;  // counter-clockwise as seen from the eye
  };
  return inside(a, b) && inside(b, c) && inside(c, a);
}

// Boxes of pixels as one.
scene::Sky coarse(const scene::Sky& sky) {
  if (sky.width <= sample_columns) return sky;
  scene::Sky result{.width = sample_columns, .height = sample_columns / 2, .radiance = {}, .light = sky.light};
  std::vector<glm::vec4> sums(std::size_t{result.width} * result.height, glm::vec4(0));
  for (std::uint32_t row = 0; row < sky.height; ++row)
    for (std::uint32_t column = 0; column < sky.width; ++column)
      sums[std::size_t{row} * result.height / sky.height * result.width +
           std::size_t{column} * result.width / sky.width] +=
          scene::solid_angle_of(sky, row) * glm::vec4(sky.radiance[std::size_t{row} * sky.width + column], 1);
  for (const auto& sum : sums) result.radiance.push_back(glm::vec3(sum) / sum.w);
  return result;
}

// What each patch hides of the sky: radiance over its solid angle [W m^-2].
std::vector<glm::vec3> fluxes(const std::vector<AreaLamp>& lamps, const scene::Sky& sky, const glm::vec3& eye) {
  std::vector<glm::vec3> found(lamps.size(), glm::vec3(0));
  for (std::uint32_t row = 0; row < sky.height; ++row)
    for (std::uint32_t column = 0; column < sky.width; ++column) {
      const glm::vec3 direction = scene::direction_of(sky, column, row);
      const auto lamp = std::ranges::find_if(
          lamps, [&](const AreaLamp& one) { return meets(one.patches[0], eye, direction); });
      if (lamp != lamps.end())
        found[static_cast<std::size_t>(lamp - lamps.begin())] +=
            scene::solid_angle_of(sky, row) * sky.radiance[std::size_t{row} * sky.width + column];
    }
  return found;
}

// Each sample's intensity becomes the sky's radiance around it; all of a patch together send what it hides.
void paint(std::vector<AreaLamp>& lamps, const scene::Sky& sky, const glm::vec3& eye) {
  const auto around = coarse(sky);
  const auto flux = fluxes(lamps, sky, eye);
  for (std::size_t k = 0; k < lamps.size(); ++k) {
    const auto& patch = lamps[k].patches[0];
    const float share = glm::length(glm::cross(patch.u, patch.v)) / 2 / static_cast<float>(samples_of_lamp);
    for (auto& samples : lamps[k].samples) {
      glm::vec3 sum(0);
      for (std::uint32_t i = 0; i < samples_of_lamp; ++i) {
        const glm::vec3 way = glm::vec3(samples.x[i], samples.y[i], samples.z[i]) - eye;
        const float distance = glm::length(way),
                    out = -glm::dot(way, glm::vec3(samples.nx[i], samples.ny[i], samples.nz[i])) / distance;
        samples.intensity[i] = scene::radiance_of(around, way / distance);
        sum += share * out / (distance * distance) * samples.intensity[i];
      }
      for (auto& intensity : samples.intensity)
        for (int channel = 0; channel < 3; ++channel)
          if (sum[channel] > 0) intensity[channel] *= flux[k][channel] / sum[channel];
    }
  }
}

}  // namespace

std::vector<AreaLamp> sky_lamps(const scene::Sky& sky, const scene::Sphere& around, std::uint32_t sets) {
  std::vector<AreaLamp> lamps;
  const bool even = sky.radiance.size() == 1;
  for (auto patch : sky_patches(around)) {
    if (even) patch.emission = sky.radiance[0];
    auto& lamp = lamps.emplace_back();
    lamp.light = sky.light;
    lamp.coloured = !even;
    lamp.soft = true;
    lamp.patches = {patch};
    for (std::uint32_t set = 0; set < sets; ++set) {
      // By the plastic number, as the lattice of samples is by the golden one (Roberts 2018, "The Unreasonable
      // Effectiveness of Quasirandom Sequences").
      const float turn = static_cast<float>(set) * 0.7548776662f, count = static_cast<float>(sets);
      place_samples(lamp, {(static_cast<float>(set) + 0.5f) / count - 0.5f, turn - std::floor(turn)});
    }
  }
  if (!even) paint(lamps, sky, around.centre);
  std::erase_if(lamps, [](const AreaLamp& lamp) {
    return std::ranges::all_of(lamp.samples, [](const LampSamples& samples) {
      return std::ranges::all_of(samples.intensity, [](const glm::vec3& one) { return one == glm::vec3(0); });
    });
  });
  return lamps;
}

}  // namespace lichtveld::lightfield
