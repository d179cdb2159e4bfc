// Light fields as tests use them: bodies put somewhere, and the light of that.
#pragma once

#include "lichtveld/lightfield/engine.hpp"

namespace lichtveld::testing {

inline scene::Offsets at_rest(const scene::Scene& scene) {
  return scene::Offsets(scene.bodies.size(), glm::vec3(0));
}

// All the light there is.
inline const lightfield::Solution& settled(lightfield::LightField& light, const scene::Offsets& offsets) {
  light.place(offsets);
  return light.settle();
}

// A step's, as somebody who moves sees it.
inline const lightfield::Solution& stepped(
    lightfield::LightField& light, const scene::Offsets& offsets,
    const lightfield::LightField::Enough& enough = [](std::uint32_t) { return true; }) {
  light.place(offsets);
  return light.step(enough);
}

}  // namespace lichtveld::testing
