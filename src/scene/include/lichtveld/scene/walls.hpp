// Where geometry stands on geometry: the lines in a triangle's plane that light and sight do not cross along
// it.
#pragma once

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {

// A line from which something rises above a triangle's plane, or falls away below it, world space [m]. Seen
// from the side of the triangle's NORMAL its middle lies to the left of a -> b.
struct Wall {
  glm::vec3 a, b;
  bool rises;
};

struct Walls {
  std::vector<std::uint32_t> first;  // of each triangle in `lines`; one more at the end
  std::vector<Wall> lines;
};

// For every triangle of Scene::indices the lines in or near it where other triangles leave its plane: towards
// the side of its NORMAL, as walls do, and blocks that stand on it; or to the other side only, as at the edges
// of a block's top. What starts up to `gap` above the plane counts as standing on it [m]. Lines farther than
// `reach` from the triangle are left out [m]; so are surfaces that it bends into smoothly, by less than 45
// degrees. Body i is shifted by offsets[i] [m]. Costs the pairs of triangles whose boxes are within `reach`.
Walls find_walls(const Scene& scene, const std::vector<glm::vec3>& offsets, float gap, float reach);

}  // namespace lichtveld::scene
