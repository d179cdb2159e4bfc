// Where the bodies of a room are, and where a step leads.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::room {

// Of the scene's movable bodies in its order, each its node's origin, world space [m]. Those of a room need not
// be all of the scene's: bodies beyond its last one stand at rest.
using Places = std::vector<glm::vec3>;

// Along the scene's x (left, right) and y (down, up).
enum class Direction { left, right, down, up };

// Of the first `most` movable bodies.
Places places_at_rest(const scene::Scene& scene, std::size_t most = std::numeric_limits<std::size_t>::max());

// Throws std::invalid_argument for more places than there are movable bodies.
scene::Offsets offsets_of(const scene::Scene& scene, const Places& places);

// Where body `index` of `places` gets with one step, scene::step_length long: as far as it is free.
glm::vec3 stepped(const scene::Scene& scene, const Places& places, std::size_t index, Direction direction);

}  // namespace lichtveld::room
