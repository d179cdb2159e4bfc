// The steps of load(), each from tinygltf's model. All throw SceneError without the file's name.
#pragma once

#include <tiny_gltf.h>

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cut.hpp"
#include "lichtveld/scene/scene.hpp"
#include "lichtveld/scene/unwrap.hpp"
#include "remarks.hpp"
#include "textures.hpp"

namespace lichtveld::scene {

struct Materials {
  std::vector<Material> materials;         // as in the file, and behind them glTF's default material
  std::vector<Texture> textures;           // those that a base colour asks for
  std::vector<TextureCoordinates> colour;  // where a material's texture is read
  std::vector<Uneven> uneven;              // what it has besides
};

Materials read_materials(const tinygltf::Model& model);

// A node of the scene. Nodes come in the order of the file.
struct PlacedNode {
  int node = 0;
  glm::dmat4 world{1};
  bool visible = true;  // KHR_node_visibility, of it and all above
  // The outermost node at or above this one with extras.movable, or -1, and the one that is a Light.
  int movable = -1, light = -1;
};

// Whether extras have this as true.
bool says(const tinygltf::Value& extras, const char* name);

// The default scene, or else scene 0.
int scene_of(const tinygltf::Model& model);

// Whether extras make a Light of what has them, and that light; `what` is its owner for messages.
bool are_of_light(const tinygltf::Value& extras);
Light light_of(const tinygltf::Value& extras, const std::string& node, const std::string& what);

// The nodes of scene_of(), each reached exactly once. Those called as one of `lights` are Lights, too.
std::vector<PlacedNode> place_nodes(const tinygltf::Model& model, std::span<const std::string> lights);

// Indices into Scene::bodies and Scene::lights by a PlacedNode's, 0 for -1.
struct Owners {
  std::map<int, std::uint32_t> body = {{-1, 0}}, light = {{-1, 0}};
};

// The KHR_lights_punctual of these nodes, their numbers divided by `lumens_per_watt`.
std::vector<PunctualLight> read_lights(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes,
                                       const Owners& owners, double lumens_per_watt);

// 64 triangles a texel of a 256 x 256 atlas, and 1 GB at worst: more is a mistake.
inline constexpr std::size_t max_triangles = std::size_t{1} << 22;

// A scene without a triangle that has an area.
inline constexpr const char* nothing_to_light = "has no triangles with an area: nothing to light";

// How far an exporter's rounding may push a TEXCOORD_1 out of the unit square; it is pulled back.
inline constexpr float atlas_rounding = 0.01f;

using Triangle = std::array<std::uint32_t, 3>;  // elements of a primitive's accessors

// The triangles of a primitive, of lists, strips and fans; nothing for points and lines. `what` names it in
// messages. Takes what it reads from `triangles_left`, and throws SceneError where that is not enough.
std::optional<std::vector<Triangle>> triangles_of(const tinygltf::Model& model,
                                                  const tinygltf::Primitive& primitive,
                                                  std::size_t& triangles_left, const std::string& what);

// unwrap() of a file whose model is read already; nothing where its own TEXCOORD_1 stays.
std::optional<Unwrapped> unwrap(const std::filesystem::path& file, const tinygltf::Model& model,
                                const UnwrapOptions& options);

// What was odd but harmless, over all primitives.
struct Oddities {
  std::size_t zero_area = 0, zero_chart = 0, outside_atlas = 0, no_triangles = 0, bad_normals = 0;
  Remarks remarks;
};

// Where a primitive stands, and in which shape.
struct Placement {
  std::string node;
  std::uint32_t primitive = 0, body = 0;
  glm::dmat4 world{1};
  std::span<const double> weights = {};    // of its morph targets; of those that it does not name, 0
  std::span<const glm::dmat4> poses = {};  // of its skin's joints, which stand for `world`
};

// Appends a primitive's vertices to scene.vertices and returns its triangles' indices into them. `colour` as in
// Materials; `emission_at` gets the coordinate of each new vertex in the emission's texture, if there is one.
// Takes what it reads from `triangles_left`, and throws SceneError where that is not enough.
std::vector<std::uint32_t> add_primitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                         const Placement& placement, const TextureCoordinates& colour,
                                         const Uneven& uneven, std::vector<glm::vec2>& emission_at,
                                         std::size_t& triangles_left, Scene& scene, Oddities& oddities);

}  // namespace lichtveld::scene
