// The pieces of all meshes where the scene's nodes show them, and what lies in them.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "sheets.hpp"
#include "welding.hpp"

namespace lichtveld::scene {

class BodiesInSpace {
 public:
  // Of the fronts of all sheets. `others`: places of other things that may lie in a body [m].
  explicit BodiesInSpace(const Meshes& meshes, std::span<const glm::vec3> others = {});

  const Bodies& of(int mesh) const { return meshes_.at(mesh).bodies; }
  const std::vector<Places>& places_of(int mesh) const { return meshes_.at(mesh).places; }

  // Whether no other body's middle, and none of the others, lies within the box of a closed body, at all nodes
  // that show it.
  bool is_alone(int mesh, std::size_t body) const { return meshes_.at(mesh).alone[body]; }

  // Whether a triangle, counted over all sheets of the mesh, is of a body that is seen from outside alone.
  bool is_solid_alone(int mesh, std::size_t triangle) const {
    const auto& [bodies, places, alone] = meshes_.at(mesh);
    const auto body = bodies.of[triangle];
    return bodies.is_solid(body) && alone[body];
  }

 private:
  struct OfMesh {
    Bodies bodies;
    std::vector<Places> places;  // of its triangles' corners
    std::vector<bool> alone;     // by body
  };
  std::map<int, OfMesh> meshes_;
};

}  // namespace lichtveld::scene
