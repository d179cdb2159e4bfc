// A glTF scene as plain data on the CPU, ready for the light field: triangles in world space with an atlas
// coordinate each, materials, textures, and the bodies that players can move. Lengths are metres, as in glTF.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/ext/vector_uint4_sized.hpp>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace lichtveld::scene {

// A scene file that cannot be used. The message says what is wrong, in which file and node, and what to try.
struct SceneError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Vertex {
  glm::vec3 position;        // metres, world space with every body at rest
  glm::vec3 normal;          // unit, world space; the face's own where the file has no NORMAL
  glm::vec2 atlas;           // TEXCOORD_1; v = 0 is the atlas' top row
  glm::vec2 colour;          // where its base colour's texture is read
  std::uint32_t body;        // index into Scene::bodies; 0 is everything that stands still
  glm::u16vec4 tint{65535};  // COLOR_0 times 65535, linear: rgb is a factor of the base colour
};

// How a texture goes on along one axis where its coordinate leaves 0..1.
enum class Wrap : std::uint32_t { repeat, mirror, clamp };

struct Material {
  std::string name;
  glm::vec3 base_colour{1};                                 // linear reflectance factor, 0..1
  int texture = -1;                                         // index into Scene::textures, or -1
  std::array<Wrap, 2> wrap = {Wrap::repeat, Wrap::repeat};  // the texture's, along u and v
  glm::vec3 emission{0};  // radiance Le [W m^-2 sr^-1]: emissiveFactor * KHR_materials_emissive_strength
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
  std::uint32_t light = 0;  // index into Scene::lights; means something where the material emits
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

// What is scaled as one. Light 0 is all that shines as it is; 1.. are the nodes with extras.switchable, flicker
// or schedule, in the order of the file, each with everything below it, and the sky if its scene has one of
// these.
struct Light {
  std::string node;
  glm::vec3 place{0};  // the middle of what shines, bodies at rest [m]
  std::uint32_t body = 0;
  bool switchable = false;  // by players
  float flicker = 0;        // extras.flicker: the share of its light that comes and goes, as a candle's, 0..1
  float day = 0;            // extras.schedule: by the sun of a day that takes so long [minutes]; 0: by none
};

// What the sky is called among the lights.
inline constexpr const char* sky_name = "sky";

// Times what the file says each light gives, a colour each, one entry a light.
using Scales = std::vector<glm::vec3>;

constexpr double sun_angle = 0.53;  // as the sun is seen from the earth [degrees]

// A light without a surface (KHR_lights_punctual). The file's numbers are taken as they are, as three.js reads
// them, for watts.
struct PunctualLight {
  enum class Kind { directional, point, spot };
  std::string node;
  Kind kind = Kind::point;
  // Point and spot: I [W sr^-1], E = I cos / d^2. Directional: E of what faces it [W m^-2].
  glm::vec3 intensity{0};
  glm::vec3 place{0};                                    // world space with every body at rest [m]
  glm::vec3 direction{0, 0, -1};                         // unit: where it shines
  float range = std::numeric_limits<float>::infinity();  // [m]
  float inner_cosine = 1, outer_cosine = 0;              // of a spot's cones
  float radius = 0;                                      // extras.radius of a point or spot [m]
  float angle = 0;  // extras.angle of a directional light, across [degrees]
  std::uint32_t body = 0, light = 0;
};

// Light from outside, from everywhere where a ray leaves the scene.
struct Sky {
  // L [W m^-2 sr^-1] in equirectangular pixels as three.js reads them: row 0 looks along +y, the columns from
  // -x on round by -z, +x and +z.
  std::uint32_t width = 1, height = 1;
  std::vector<glm::vec3> radiance = {glm::vec3(0)};
  std::uint32_t light = 0;
};

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
  std::vector<PunctualLight> punctual;
  std::optional<Sky> sky;
  std::vector<Light> lights;
  // Where the file's own atlas cannot be used: the scene as one .glb with the one that was made (unwrap.hpp),
  // and the texels a side at which its charts lie on whole texels, two apart; else empty and 0.
  std::vector<std::uint8_t> unwrapped;
  std::uint32_t unwrapped_size = 0;
  // With UnwrapOptions::light_map: the file that `unwrapped` names and that is not in it, its sky; or empty.
  std::string beside;
};

struct UnwrapOptions {
  std::uint32_t size = 256;     // texels a side, 16..4096; doubled until the charts find room
  double texels_per_metre = 0;  // 0: as many as find room
  bool keep_uv = false;         // refuse instead, in load()
  // The URI of its light map, which the written file names in extras.lightMap of its scene; empty: what it has.
  std::string light_map = {};
};

struct LoadOptions {
  // "R,G,B", the same radiance from everywhere, or the name of an equirectangular .hdr or .exr; empty: what the
  // file says (extras.sky of the scene, EXT_lights_image_based).
  std::string sky = {};
  // Names of nodes that are lights of their own whatever their extras; sky_name is the sky.
  std::vector<std::string> lights = {};
  double lumens_per_watt = 1;  // that the file's punctual lights are divided by
  UnwrapOptions unwrap = {};
};

// Reads a .glb or .gltf file. Throws SceneError for a file that is missing, damaged or hostile, or that lacks
// what the light field needs (triangles), or for options that name nothing in it. Where TEXCOORD_1 is missing
// or cannot be used, the scene is unwrapped (unwrap.hpp). What is odd but harmless (zero-area triangles, no
// emitter) is logged as a warning.
Scene load(const std::filesystem::path& file, const LoadOptions& options = {});

// The smallest sphere around the scene's bounding box with body i shifted by offsets[i] [m] (offsets may be
// shorter than Scene::bodies; what is absent has not moved).
Sphere bounding_sphere(const Scene& scene, const Offsets& offsets = {});

// Whether two triangles of Scene::indices are of surfaces whose node has the same name.
bool of_one_node(const Scene& scene, std::uint32_t a, std::uint32_t b);

// The index of the movable body whose node has that name. Throws SceneError that lists the movable nodes.
std::uint32_t find_body(const Scene& scene, const std::string& node);

// The indices of the lights whose node has that name. Throws SceneError that lists the lights.
std::vector<std::uint32_t> find_lights(const Scene& scene, const std::string& node);

}  // namespace lichtveld::scene
