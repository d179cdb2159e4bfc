// A glTF scene as plain data on the CPU, ready for the light field: triangles in world space with an atlas
// coordinate each, materials, textures, and the bodies that players can move. Lengths are metres, as in glTF.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace lichtveld::scene {

// A scene file that cannot be used. The message says what is wrong, in which file and node, and what to try.
struct SceneError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Vertex {
  glm::vec3 position;  // metres, world space with every body at rest
  glm::vec3 normal;    // unit, world space; the face's own where the file has no NORMAL
  glm::vec2 atlas;     // TEXCOORD_1; v = 0 is the atlas' top row
  glm::vec2 colour;    // the coordinate set that baseColorTexture asks for
  std::uint32_t body;  // index into Scene::bodies; 0 is everything that stands still
};

struct Material {
  std::string name;
  glm::vec3 base_colour{1};  // linear reflectance factor, 0..1
  int texture = -1;          // index into Scene::textures, or -1
  glm::vec3 emission{0};     // radiance Le [W m^-2 sr^-1]: emissiveFactor * KHR_materials_emissive_strength
  bool double_sided = false;
};

// 8-bit sRGB pixels, row 0 on top.
struct Texture {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

// One glTF primitive of one node: a run of Scene::indices with one material. One-sided surfaces stand before
// the double-sided ones in Scene::surfaces, so that each kind is one run of indices.
struct Surface {
  std::string node;  // the node's name, or "node 7"
  std::uint32_t first_index = 0, index_count = 0;
  std::uint32_t material = 0, body = 0;
};

struct Box {
  glm::vec3 min{0}, max{0};  // metres
};

// What moves as one. Body 0 is the part of the scene that stands still; 1.. are the nodes with extras.movable,
// in the order of the file, each with everything below it.
struct Body {
  std::string node;
  glm::vec3 place{0};  // the node's origin at rest, world space [m]
  Box box;             // of its triangles at rest, world space [m]
};

// How far each body is from its place at rest [m], one entry a body; the first, which stands still, is 0.
using Offsets = std::vector<glm::vec3>;

// The sphere that the light field scales to the unit sphere.
struct Sphere {
  glm::vec3 centre{0};
  float radius = 1;  // metres, > 0
};

struct Scene {
  std::string file;
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  // three a triangle, counter-clockwise seen from the front
  std::uint32_t one_sided_indices =
      0;  // the first so many indices are one-sided surfaces, the rest double-sided
  std::vector<Surface> surfaces;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Body> bodies;
};

// Reads a .glb or .gltf file. Throws SceneError for a file that is missing, damaged or hostile, or that lacks
// what the light field needs (triangles, TEXCOORD_1). What is odd but harmless (zero-area triangles, no
// emitter) is logged as a warning.
Scene load(const std::filesystem::path& file);

// The smallest sphere around the scene's bounding box with body i shifted by offsets[i] [m] (offsets may be
// shorter than Scene::bodies; what is absent has not moved).
Sphere bounding_sphere(const Scene& scene, const Offsets& offsets = {});

// Whether two triangles of Scene::indices are of surfaces whose node has the same name.
bool of_one_node(const Scene& scene, std::uint32_t a, std::uint32_t b);

// The index of the movable body whose node has that name. Throws SceneError that lists the movable nodes.
std::uint32_t find_body(const Scene& scene, const std::string& node);

}  // namespace lichtveld::scene
