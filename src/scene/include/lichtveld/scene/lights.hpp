// What of a scene gives light.
#pragma once

#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {

// The triangles of Scene::indices whose material emits, in their order.
std::vector<std::uint32_t> emitting_triangles(const Scene& scene);

}  // namespace lichtveld::scene
