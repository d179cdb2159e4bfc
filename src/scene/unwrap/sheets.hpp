// What of a scene is laid flat: its meshes' primitives, and the nodes that show them.
#pragma once

#include <tiny_gltf.h>

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "charts.hpp"
#include "parts.hpp"

namespace lichtveld::scene {

// A primitive of a mesh.
struct Sheet {
  std::size_t primitive = 0;  // in the mesh
  std::string what;           // for messages
  bool double_sided = false;
  std::vector<Triangle> triangles;            // elements of its accessors
  std::vector<Corners> corners;               // of each triangle, in the mesh's space
  std::size_t fronts = 0;                     // the triangles behind these are backs of some
  std::vector<std::array<glm::vec2, 3>> own;  // of each triangle, where it has a usable TEXCOORD_1
  std::vector<Chart> charts;
};

// A node of the scene that shows a mesh.
struct Use {
  int node = 0;
  std::string name;
  glm::dmat4 world{1};
  double density = 1;         // extras.texels
  std::vector<double> posed;  // of a skin: the area of each sheet [m2]
};

// A mesh, and the nodes of the scene that show it.
struct UsedMesh {
  std::vector<Sheet> sheets;
  std::vector<Use> uses;
};

using Meshes = std::map<int, UsedMesh>;  // by their numbers in the file

// Those of the default scene, without charts. Throws SceneError.
Meshes used_meshes(const tinygltf::Model& model);

// Why the scene's own atlas cannot be used, or nothing.
std::string fault_of(const Meshes& meshes);

// Gives double-sided surfaces backs of their own, where they may be seen: not on the outside of a closed body
// that nothing of the scene lies in.
void add_backs(Meshes& meshes);

// The area of a sheet of the mesh as the node shows it [m2].
double area_in_world(const UsedMesh& mesh, std::size_t sheet, const Use& use);

// By how much longer things are in the world than in the mesh, for a sheet as a whole, times the node's
// density.
double scale_of(const UsedMesh& mesh, std::size_t sheet, const Use& use);

}  // namespace lichtveld::scene
