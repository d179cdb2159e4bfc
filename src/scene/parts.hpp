// The steps of load(), each from tinygltf's model. All throw SceneError without the file's name.
#pragma once

#include <tiny_gltf.h>

#include <glm/glm.hpp>
#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {

struct Materials {
  std::vector<Material> materials;  // as in the file, and behind them glTF's default material
  std::vector<Texture> textures;    // those that a base colour asks for
  std::vector<int> colour_set;      // a material's TEXCOORD set for its texture, or -1
};

Materials read_materials(const tinygltf::Model& model);

// A node of the scene. Nodes come in the order of the file.
struct PlacedNode {
  int node = 0;
  glm::dmat4 world{1};
  int movable = -1;  // the outermost node at or above this one with extras.movable, or -1
};

// The nodes of the default scene (or else of scene 0), each reached exactly once.
std::vector<PlacedNode> place_nodes(const tinygltf::Model& model);

// What was odd but harmless, counted over all primitives.
struct Oddities {
  std::size_t zero_area = 0, zero_chart = 0, no_triangles = 0, bad_normals = 0;
};

// Where a primitive stands.
struct Placement {
  std::string node;
  std::uint32_t primitive = 0, body = 0;
  glm::dmat4 world{1};
};

// Appends a primitive's vertices to scene.vertices and returns its triangles' indices into them, of
// which there are at most `max_triangles`. `colour_set` as in Materials.
std::vector<std::uint32_t> add_primitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                         const Placement& placement, int colour_set, std::size_t max_triangles,
                                         Scene& scene, Oddities& oddities);

}  // namespace lichtveld::scene
