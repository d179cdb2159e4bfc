// load(): the parts put together.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>

#include "lichtveld/scene/lights.hpp"
#include "model.hpp"
#include "parts.hpp"

namespace lichtveld::scene {
namespace {

// 64 triangles a texel of a 256 x 256 atlas, and 1 GB at worst: more is a mistake.
constexpr std::size_t max_triangles = std::size_t{1} << 22;

std::vector<Body> find_bodies(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes,
                              std::map<int, std::uint32_t>& body_of) {
  std::vector<Body> bodies{{"standing scene", {}, {}}};
  for (const PlacedNode& placed : nodes) {
    if (placed.movable != placed.node) continue;
    body_of[placed.node] = static_cast<std::uint32_t>(bodies.size());
    const glm::vec3 place = placed.world[3];
    bodies.push_back({node_name(model, placed.node), place, {place, place}});
  }
  return bodies;
}

void measure_bodies(Scene& scene) {
  std::vector<bool> started(scene.bodies.size());
  for (const Vertex& vertex : scene.vertices) {
    Box& box = scene.bodies[vertex.body].box;
    if (!started[vertex.body]) box = {vertex.position, vertex.position};
    started[vertex.body] = true;
    box = {glm::min(box.min, vertex.position), glm::max(box.max, vertex.position)};
  }
}

struct Piece {
  Surface surface;
  std::vector<std::uint32_t> indices;
};

std::vector<Piece> read_pieces(const tinygltf::Model& model, const Materials& materials, Scene& scene,
                               Oddities& oddities) {
  const std::vector<PlacedNode> nodes = place_nodes(model);
  std::map<int, std::uint32_t> body_of{{-1, 0}};
  scene.bodies = find_bodies(model, nodes, body_of);
  std::vector<Piece> pieces;
  std::size_t triangles_left = max_triangles;
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(placed.node)];
    if (node.mesh == -1) continue;
    const std::string name = node_name(model, placed.node);
    if (node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= model.meshes.size()) {
      throw SceneError("node \"" + name + "\": there is no mesh " + std::to_string(node.mesh));
    }
    if (node.skin >= 0) spdlog::warn("{}: node \"{}\" has a skin, which is ignored", scene.file, name);
    const auto& primitives = model.meshes[static_cast<std::size_t>(node.mesh)].primitives;
    for (std::uint32_t i = 0; i < primitives.size(); ++i) {
      const int material = primitives[i].material;
      if (material < -1 || (material >= 0 && static_cast<std::size_t>(material) >= model.materials.size())) {
        throw SceneError("node \"" + name + "\", primitive " + std::to_string(i) + ": there is no material " +
                         std::to_string(material));
      }
      const std::size_t slot = material < 0 ? model.materials.size() : static_cast<std::size_t>(material);
      const std::uint32_t body = body_of.at(placed.movable);
      Piece piece{{name, 0, 0, static_cast<std::uint32_t>(slot), body}, {}};
      piece.indices = add_primitive(model, primitives[i], {name, i, body, placed.world},
                                    materials.colour_set[slot], triangles_left, scene, oddities);
      triangles_left -= piece.indices.size() / 3;
      if (!piece.indices.empty()) pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

void warn_of(const Scene& scene, const Oddities& oddities) {
  if (oddities.zero_area) {
    spdlog::warn("{}: {} triangles without area were dropped", scene.file, oddities.zero_area);
  }
  if (oddities.zero_chart) {
    spdlog::warn("{}: {} triangles have no area in TEXCOORD_1 and get no texels of their own", scene.file,
                 oddities.zero_chart);
  }
  if (oddities.no_triangles) {
    spdlog::warn("{}: {} primitives of points or lines were left out", scene.file, oddities.no_triangles);
  }
  if (oddities.bad_normals) {
    spdlog::warn("{}: {} primitives have unusable normals; their faces' own are used", scene.file,
                 oddities.bad_normals);
  }
  if (emitting_triangles(scene).empty())
    spdlog::warn("{}: nothing emits light; give a material an emissiveFactor", scene.file);
}

Scene read_scene(const std::filesystem::path& file) {
  const tinygltf::Model model = read_model(file);
  Scene scene;
  scene.file = file.string();
  Materials materials = read_materials(model);
  Oddities oddities;
  std::vector<Piece> pieces = read_pieces(model, materials, scene, oddities);
  scene.materials = std::move(materials.materials);
  scene.textures = std::move(materials.textures);
  if (pieces.empty()) throw SceneError("has no triangles with an area: nothing to light");

  const auto one_sided = [&](const Piece& piece) {
    return !scene.materials[piece.surface.material].double_sided;
  };
  const auto double_sided = std::stable_partition(pieces.begin(), pieces.end(), one_sided);
  for (auto piece = pieces.begin(); piece != pieces.end(); ++piece) {
    if (piece == double_sided) scene.one_sided_indices = static_cast<std::uint32_t>(scene.indices.size());
    piece->surface.first_index = static_cast<std::uint32_t>(scene.indices.size());
    piece->surface.index_count = static_cast<std::uint32_t>(piece->indices.size());
    scene.indices.insert(scene.indices.end(), piece->indices.begin(), piece->indices.end());
    scene.surfaces.push_back(std::move(piece->surface));
  }
  if (double_sided == pieces.end()) scene.one_sided_indices = static_cast<std::uint32_t>(scene.indices.size());
  measure_bodies(scene);
  warn_of(scene, oddities);
  return scene;
}

// Names in a file are anybody's text: no control characters reach a terminal or log, and no message is endless.
std::string printable(std::string text) {
  if (text.size() > 600) text = text.substr(0, 600) + "...";
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

}  // namespace

Scene load(const std::filesystem::path& file) {
  try {
    return read_scene(file);
  } catch (const std::bad_alloc&) {
    throw SceneError(file.string() + ": not enough memory to read it");
  } catch (const std::exception& e) {  // our own errors, and what tinygltf lets escape from its parser
    throw SceneError(printable(file.string() + ": " + e.what()));
  }
}

}  // namespace lichtveld::scene
