// What is worth a change, and which.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <functional>

#include "facts.hpp"

namespace lichtveld::scene {
namespace {

using Severity = Finding::Severity;

// Rooms are a few metres large. Beyond this radius a scene in metres is rare, in centimetres and millimetres
// usual [m].
constexpr float like_centimetres = 100, like_millimetres = 1250, enormous = 50'000, tiny = 0.05f;
// Of the area, whose triangles hold no texel's centre while their charts do.
constexpr double much_area = 0.01;

// "node "a"" or "nodes "a", "b", "c" and 4 more".
std::string named(const std::vector<std::string>& nodes) {
  constexpr std::size_t most_named = 3;
  std::string text = nodes.size() == 1 ? "node " : "nodes ";
  for (std::size_t i = 0; i < std::min(nodes.size(), most_named); ++i)
    text += fmt::format("{}\"{}\"", i > 0 ? ", " : "", nodes[i]);
  if (nodes.size() > most_named) text += fmt::format(" and {} more", nodes.size() - most_named);
  return text;
}

class Findings {
 public:
  explicit Findings(const SceneFacts& facts) : facts_(facts) {}

  std::vector<Finding> all() {
    look_at_atlas();
    look_at_meshes();
    look_at_scale();
    return std::move(found_);
  }

 private:
  void add(const char* id, Severity severity, std::size_t count, std::string text, std::string advice) {
    found_.push_back({id, severity, count, std::move(text), std::move(advice)});
  }

  void look_at_atlas() {
    const auto& atlas = facts_.atlas;
    const auto& unwrapped = facts_.unwrapped;
    if (atlas.texels == 0)
      add("no_texel", Severity::warning, 1,
          fmt::format("no texel of {0} x {0} lies on a chart: bake refuses it", atlas.size),
          "enlarge the charts in TEXCOORD_1, or leave it out, or bake with a larger --size");
    if (unwrapped)
      add("unwrapped", Severity::note, unwrapped->charts,
          "it is unwrapped before it is baked: " + unwrapped->reason,
          "nothing, or keep the atlas that `lichtveld unwrap` writes");
    if (unwrapped && unwrapped->size > atlas.size)
      add("size_too_small", Severity::warning, unwrapped->charts,
          fmt::format("its {} charts find no room in {} x {} texels", unwrapped->charts, atlas.size,
                      atlas.size),
          fmt::format("bake it with --size {}", unwrapped->size));
    if (atlas.shared.texels > 0)
      add("shared_texels", Severity::warning, atlas.shared.texels,
          "charts overlap in TEXCOORD_1: " + text_of(atlas.shared) + " texels",
          unwrapped ? "bake with a larger --size"
                    : "move these charts apart, or leave TEXCOORD_1 out, and it is unwrapped");
    if (atlas.charts_without_texel > 0)
      add("charts_without_texel", Severity::warning, atlas.charts_without_texel,
          fmt::format("{} of {} charts hold no texel's centre, that of node \"{}\" among them",
                      atlas.charts_without_texel, atlas.charts, atlas.node_without_texel),
          fmt::format(
              "bake with --size {}, or {}", 2 * atlas.size,
              unwrapped ? "give these nodes extras.texels above 1" : "enlarge these charts in TEXCOORD_1"));
    else if (atlas.area_without_texel > much_area * facts_.area)
      add("triangles_without_texel", Severity::note, atlas.triangles_without_texel,
          fmt::format("{} triangles ({:.2g} % of the area) hold no texel's centre, though their charts do",
                      atlas.triangles_without_texel, 100 * atlas.area_without_texel / facts_.area),
          fmt::format("bake with --size {} where their light has to be their own", 2 * atlas.size));
  }

  // One line for all meshes of which something is to be told.
  void add_of_meshes(const char* id, Severity severity, const std::function<std::size_t(const MeshFacts&)>& of,
                     const char* what, const char* advice) {
    std::size_t count = 0;
    std::vector<std::string> nodes;
    for (const auto& mesh : facts_.meshes)
      if (const std::size_t of_mesh = of(mesh); of_mesh > 0) {
        count += of_mesh;
        nodes.push_back(mesh.node);
      }
    if (count > 0) add(id, severity, count, fmt::format("{}: {} {}", named(nodes), count, what), advice);
  }

  void look_at_meshes() {
    add_of_meshes("inside_out", Severity::warning, &MeshFacts::inside_out,
                  "closed bodies face inwards, and nothing is in them: from outside they are not there",
                  "flip their faces (in Blender: recalculate outside)");
    add_of_meshes("flipped_edges", Severity::warning, &MeshFacts::flipped_edges,
                  "edges lie between triangles that face opposite ways",
                  "make the faces consistent (in Blender: recalculate outside)");
    if (!facts_.unwrapped)
      add_of_meshes("two_faced", Severity::warning, &MeshFacts::two_faced,
                    "double-sided triangles have one chart for two faces: both show the light of one",
                    "leave TEXCOORD_1 out, and each face gets its chart; or model both faces");
    add_of_meshes("non_manifold", Severity::note, &MeshFacts::non_manifold_edges,
                  "edges are of more than two triangles",
                  "nothing where sheets meet so on purpose; otherwise remove faces inside");
    const auto open = [](const MeshFacts& mesh) { return mesh.double_sided ? 0 : mesh.boundary_edges; };
    add_of_meshes("open", Severity::note, open,
                  "edges are of one triangle, one-sided: from behind it is not there, and light passes",
                  "nothing where nothing is behind; otherwise give it a thickness, or make it double-sided");
  }

  void look_at_scale() {
    const float radius = facts_.sphere.radius;
    const auto add_scale = [&](const std::string& what, const std::string& advice) {
      add("scale", Severity::warning, 1,
          fmt::format("its bounding sphere has a radius of {:.4g} m: {}", radius, what), advice);
    };
    if (radius > enormous)
      add_scale("enormous", "remove what lies far away, or scale it to metres");
    else if (radius > like_millimetres)
      add_scale("that looks like millimetres", "export it in metres, or scale its root nodes by 0.001");
    else if (radius > like_centimetres)
      add_scale("that looks like centimetres", "export it in metres, or scale its root nodes by 0.01");
    else if (radius < tiny)
      add_scale("tiny", "export it in metres: glTF's unit is the metre");
  }

  const SceneFacts& facts_;
  std::vector<Finding> found_;
};

}  // namespace

std::vector<Finding> findings_in(const SceneFacts& facts) {
  return Findings(facts).all();
}

}  // namespace lichtveld::scene
