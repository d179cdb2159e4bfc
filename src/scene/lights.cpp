#include "lichtveld/scene/lights.hpp"

namespace lichtveld::scene {

std::vector<std::uint32_t> emitting_triangles(const Scene& scene) {
  std::vector<std::uint32_t> triangles;
  for (const Surface& surface : scene.surfaces)
    if (scene.materials[surface.material].emission != glm::vec3(0))
      for (std::uint32_t corner = 0; corner < surface.index_count; corner += 3)
        triangles.push_back((surface.first_index + corner) / 3);
  return triangles;
}

}  // namespace lichtveld::scene
