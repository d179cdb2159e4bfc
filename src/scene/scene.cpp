#include "lichtveld/scene/scene.hpp"

#include <algorithm>
#include <iterator>
#include <set>

namespace lichtveld::scene {

Sphere bounding_sphere(const Scene& scene, const Offsets& offsets) {
  // Bodies without triangles take no room.
  std::vector<bool> has_triangles(scene.bodies.size());
  for (const Surface& surface : scene.surfaces) has_triangles[surface.body] = true;
  glm::dvec3 low(1e30), high(-1e30);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!has_triangles[i]) continue;
    const glm::dvec3 offset = i < offsets.size() ? offsets[i] : glm::vec3(0);
    low = glm::min(low, glm::dvec3(scene.bodies[i].box.min) + offset);
    high = glm::max(high, glm::dvec3(scene.bodies[i].box.max) + offset);
  }
  return {(low + high) / 2.0, static_cast<float>(glm::length(high - low) / 2)};
}

bool of_one_node(const Scene& scene, std::uint32_t a, std::uint32_t b) {
  const auto node_of = [&](std::uint32_t triangle) -> const std::string& {
    // Surfaces follow each other in Scene::indices.
    return std::prev(std::ranges::upper_bound(scene.surfaces, 3 * triangle, {}, &Surface::first_index))->node;
  };
  return node_of(a) == node_of(b);
}

std::uint32_t find_body(const Scene& scene, const std::string& node) {
  std::string names;
  std::uint32_t found = 0;
  for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].node == node) {
      if (found) throw SceneError(scene.file + ": two movable nodes are called \"" + node + "\"; rename one");
      found = static_cast<std::uint32_t>(i);
    }
    names += (i > 1 ? ", " : "") + scene.bodies[i].node;
  }
  if (found) return found;
  throw SceneError(scene.file + ": no movable node \"" + node + "\"; " +
                   (names.empty() ? "none is movable (extras.movable)" : "movable are: " + names));
}

std::vector<std::uint32_t> find_lights(const Scene& scene, const std::string& node) {
  std::set<std::string> names;
  std::set<std::uint32_t> found;
  const auto add = [&](std::uint32_t light, const std::string& own_name) {
    const auto& name = light > 0 ? scene.lights[light].node : own_name;
    names.insert(name);
    if (light > 0 && name == node) found.insert(light);
  };
  for (const auto& surface : scene.surfaces)
    if (scene.materials[surface.material].emission != glm::vec3(0)) add(surface.light, surface.node);
  for (const auto& light : scene.punctual) add(light.light, light.node);
  if (scene.sky) add(scene.sky->light, sky_name);
  if (!found.empty()) return {found.begin(), found.end()};
  std::string list;
  for (const auto& name : names) {
    list += (list.empty() ? "" : ", ") + name;
    if (list.size() > 300) break;
  }
  throw SceneError(scene.file + ": nothing that shines is called \"" + node + "\"; " +
                   (list.empty() ? "nothing does" : "there are: " + list));
}

}  // namespace lichtveld::scene
