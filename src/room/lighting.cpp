#include "lighting.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lichtveld::room {

namespace {

constexpr double noon = 12;

// Sets off each light's flicker from the others' [s].
constexpr double apart = 17.3;

}  // namespace

// Waves whose lengths have no common measure: it never repeats, and has no step.
float flicker(float share, double seconds) {
  double sum = 0, all = 0;
  for (const auto& [hertz, weight] : {std::pair{0.71, 1.0}, {2.39, 0.8}, {5.03, 0.6}, {8.87, 0.4}}) {
    sum += weight * std::sin(2 * std::numbers::pi * hertz * seconds);
    all += weight;
  }
  return 1 - share * static_cast<float>((1 - sum / all) / 2);
}

glm::vec3 daylight(double hour) {
  const double height = std::sin(2 * std::numbers::pi * (hour - 6) / 24);  // of the sun, 1 at noon
  const glm::dvec3 reddening(0.05, 0.15, 0.35);                            // by the air that is passed
  if (height <= 0) return glm::vec3(0);
  return glm::vec3(height * glm::exp(reddening * (1 - 1 / std::max(height, 0.05))));
}

bool Lighting::changes() const {
  for (std::size_t i = 0; i < set_.size(); ++i)
    if (set_[i] != glm::vec3(0) && (scene_.lights[i].flicker > 0 || scene_.lights[i].day > 0)) return true;
  return false;
}

scene::Scales Lighting::scales() const {
  const std::chrono::duration<double> passed = Clock::now() - begun_;
  scene::Scales scales = set_;
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const auto& light = scene_.lights[i];
    if (light.flicker > 0) scales[i] *= flicker(light.flicker, passed.count() + apart * static_cast<double>(i));
    if (light.day > 0) scales[i] *= daylight(std::fmod(noon + passed.count() / (60.0 * light.day) * 24, 24));
  }
  return scales;
}

}  // namespace lichtveld::room
