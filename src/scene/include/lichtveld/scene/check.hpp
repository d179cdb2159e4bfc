// What a scene holds, lacks and needs before it is baked, as facts for people and programs.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lichtveld/scene/atlas.hpp"
#include "lichtveld/scene/scene.hpp"
#include "lichtveld/scene/unwrap.hpp"

namespace lichtveld::scene {

// What reading a file remarked on.
struct Remark {
  std::string what, where;  // of what first (`node "a"`); empty where it is of the file
  std::size_t count = 0;    // of how many
  std::string advice;       // what to change; may be empty
};

// "node "a" and 3 more: has ..". Names in it are the file's, whatever characters they have.
std::string text_of(const Remark& remark);

// Names in a file are anybody's text: this is without control characters, and not endless.
std::string printable(std::string text);

// What gives light: all surfaces of a node, or of a light that switches, are one.
struct LightFacts {
  enum class Kind { surface, point, spot, directional, sky };
  std::string name;
  Kind kind = Kind::surface;
  glm::vec3 flux{0};        // of surfaces, points and spots, in all directions [W]
  glm::vec3 irradiance{0};  // of a directional light on what faces it, of the sky on open ground [W m^-2]
  bool switchable = false;
};

// A mesh of the file as far as it is shown. Corners that coincide are one here, and copies of a triangle too.
struct MeshFacts {
  std::string node;  // the first that shows it
  std::size_t nodes = 0, triangles = 0;
  std::size_t boundary_edges = 0;      // of one triangle
  std::size_t non_manifold_edges = 0;  // of more than two, where a triangle and its back count once
  std::size_t flipped_edges = 0;       // of two triangles that face opposite ways
  bool double_sided = false;           // all of it
  std::size_t closed_bodies = 0;       // pieces without such edges that hold space
  // Closed, facing inwards, one-sided, and with nothing of the scene inside: seen from outside they are not
  // there.
  std::size_t inside_out = 0;
  std::size_t two_faced = 0;  // double-sided triangles whose faces both may be seen
  double two_faced_area = 0;  // of these, over all nodes [m2]
};

// Of triangles, weighted by their area in space.
struct Spread {
  double min = 0, median = 0, max = 0;
};

// The light map's atlas at a size. A chart is what hangs together in it and in space.
struct AtlasFacts {
  std::uint32_t size = 0;
  std::uint32_t texels = 0;  // valid ones
  Spread texels_per_metre;
  std::size_t charts = 0;
  // That hold no texel's centre.
  std::size_t charts_without_texel = 0, triangles_without_texel = 0;
  double area_without_texel = 0;         // of these triangles in space [m2]
  std::string node_without_texel;        // of the first such chart
  SharedTexels shared;                   // by charts of different places
  std::vector<std::uint32_t> chart_of;   // of each texel: the chart on which its centre lies, or no_chart
  std::vector<glm::vec2> without_texel;  // the middles of such charts, 0..1 (65536 at most)

  static constexpr std::uint32_t no_chart = ~0u;
  double coverage() const { return static_cast<double>(texels) / (double{1} * size * size); }  // 0..1
};

// What is worth a change. A note may be meant so.
struct Finding {
  enum class Severity { note, warning };
  std::string id;  // stable, as in docs/check.md
  Severity severity = Severity::note;
  std::size_t count = 0;  // of what `text` speaks of
  std::string text, advice;
};

struct SceneFacts {
  std::size_t triangles = 0, pieces = 0;  // of surfaces; what textures cut them into, which is baked
  std::size_t surfaces = 0, materials = 0, textures = 0;
  double area = 0;  // [m2]
  Box box;          // bodies at rest
  Sphere sphere;
  std::vector<Body> movable;
  std::vector<LightFacts> lights;
  std::vector<std::string> switchable;  // of Scene::lights
  std::optional<Unwrapped> unwrapped;   // without its bytes; nothing where the scene's own atlas is used
  AtlasFacts atlas;
  std::vector<MeshFacts> meshes;
  std::vector<Remark> remarks;
  std::size_t remarks_left_out = 0;  // kinds beyond these
  std::vector<Finding> findings;     // warnings first
};

struct Checked {
  Scene scene;
  SceneFacts facts;
};

// Loads a scene without a word of what it says of it, and looks at all of the above; the atlas at
// options.unwrap.size texels a side, 1..16384. Time goes with triangles (times their logarithm) and texels.
// Throws SceneError as load() does. A scene that no texel shows is no error here, but a finding.
Checked check(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace lichtveld::scene
