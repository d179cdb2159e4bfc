// What a room's lights give at a time: what players have set, and what flickers or follows a day by itself.
#pragma once

#include <chrono>
#include <utility>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::room {

// A candle's light, which `share` of comes and goes: 1 - share .. 1.
float flicker(float share, double seconds);

// What sun and sky give at an hour of 0..24 times what they give at noon: nothing at night, reddish when the
// sun is low.
glm::vec3 daylight(double hour);

class Lighting {
 public:
  // The scene must outlive it. Days begin at noon, now.
  Lighting(const scene::Scene& scene, scene::Scales scales) : scene_(scene), set_(std::move(scales)) {}

  void set(scene::Scales scales) { set_ = std::move(scales); }

  // Whether any light that is on changes by itself.
  bool changes() const;
  scene::Scales scales() const;  // now

 private:
  using Clock = std::chrono::steady_clock;

  const scene::Scene& scene_;
  scene::Scales set_;
  const Clock::time_point begun_ = Clock::now();
};

}  // namespace lichtveld::room
