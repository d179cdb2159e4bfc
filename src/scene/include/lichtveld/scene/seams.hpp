// Where charts meet.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {

// An edge of one smooth surface that lies at two places of the atlas: where both sides have the same ends, and
// the same NORMALs there. Creases are none.
struct Seam {
  struct Side {
    std::uint32_t triangle;  // of Scene::indices
    glm::vec2 from, to;      // in the atlas; `from` is the same end of both sides
  };
  glm::vec3 from, to;  // bodies at rest [m]
  std::array<Side, 2> sides;
};

// In the order of the triangles.
std::vector<Seam> find_seams(const Scene& scene);

}  // namespace lichtveld::scene
