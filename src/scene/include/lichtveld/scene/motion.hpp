// How bodies move: in steps, and not into walls or other bodies.
#pragma once

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {

// The length of one step of a player's cube [m]: 1/32 of the radius of the scene's bounding sphere.
float step_length(const Scene& scene);

// How far body `body`, now shifted by offsets[body] from rest, gets when it wants to go `step` further [m]: the
// whole step, or the part of it that fits before its bounding box meets a triangle of the standing scene or
// another body's box. Touching (resting on the floor, sliding along a wall) does not block. `offsets` has one
// entry a body. A body that is already stuck in something may still move in any direction that does not make it
// worse.
glm::vec3 free_step(const Scene& scene, const Offsets& offsets, std::uint32_t body, glm::vec3 step);

}  // namespace lichtveld::scene
