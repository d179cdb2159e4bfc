#include "sheets.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "accessor.hpp"
#include "bodies_in_space.hpp"
#include "flat_triangle.hpp"
#include "model.hpp"
#include "skins.hpp"
#include "vertices.hpp"

namespace lichtveld::scene {
namespace {

// Whether an atlas is used as it is must not depend on the size that is baked: it is looked at on this raster.
constexpr std::uint32_t judged_at = 512;
constexpr double most_overlap = 0.005;  // of the cells that charts fill
// No more cells are looked at, whatever lies on each other: millions of triangles can each fill the atlas.
constexpr std::size_t most_looks = std::size_t{64} * judged_at * judged_at;
constexpr double most_flat = 0.5;  // of the surfaces' area, that has none in the atlas

std::string in_quotes(const std::string& name) {
  return '"' + name + '"';
}

// The triangle's coordinates, or nothing where the primitive has none that can be read.
std::vector<std::array<glm::vec2, 3>> own_atlas(const tinygltf::Model& model,
                                                const tinygltf::Primitive& primitive, const Sheet& sheet,
                                                std::size_t vertices) {
  const auto found = primitive.attributes.find("TEXCOORD_1");
  if (found == primitive.attributes.end() || found->second < 0) return {};
  const Accessor atlas(model, found->second, sheet.what + ", TEXCOORD_1");
  atlas.require_vectors(2);
  if (atlas.count() < vertices) return {};
  std::vector<std::array<glm::vec2, 3>> own;
  for (const auto& t : sheet.triangles) own.push_back({atlas.vec2(t[0]), atlas.vec2(t[1]), atlas.vec2(t[2])});
  return own;
}

// The sheets of a mesh in the shape that a node gives it by its weights.
std::vector<Sheet> sheets_of(const tinygltf::Model& model, int mesh, const std::string& name,
                             std::span<const double> weights, std::size_t& triangles_left) {
  const auto& primitives = model.meshes[static_cast<std::size_t>(mesh)].primitives;
  std::vector<Sheet> sheets;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const auto& primitive = primitives[i];
    Sheet sheet;
    sheet.primitive = i;
    sheet.what = "node " + in_quotes(name) + ", primitive " + std::to_string(i);
    auto triangles = triangles_of(model, primitive, triangles_left, sheet.what);
    if (!triangles) continue;
    const Vertices vertices(model, primitive, {.node = name, .weights = weights}, sheet.what);
    sheet.double_sided = primitive.material >= 0 &&
                         static_cast<std::size_t>(primitive.material) < model.materials.size() &&
                         model.materials[static_cast<std::size_t>(primitive.material)].doubleSided;
    sheet.triangles = std::move(*triangles);
    sheet.fronts = sheet.triangles.size();
    for (const auto& t : sheet.triangles)
      sheet.corners.push_back({vertices.position(t[0]), vertices.position(t[1]), vertices.position(t[2])});
    for (std::size_t t = 0; t < sheet.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (const auto& place = sheet.corners[t][k]; !std::isfinite(place.x + place.y + place.z))
          check_place(place, sheet.triangles[t][k], sheet.what);
    sheet.own = own_atlas(model, primitive, sheet, vertices.count());
    sheets.push_back(std::move(sheet));
  }
  return sheets;
}

double density_of(const tinygltf::Node& node, const std::string& name) {
  if (!node.extras.IsObject() || !node.extras.Has("texels")) return 1;
  const auto& value = node.extras.Get("texels");
  const double density = value.IsNumber() ? value.GetNumberAsDouble() : 0;
  if (!(density >= 0.01 && density <= 100))
    throw SceneError("node \"" + name + "\": extras.texels is no number of 0.01..100");
  return density;
}

Corners in_world(const Corners& corners, const glm::dmat4& world) {
  Corners result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = glm::vec3(world * glm::dvec4(corners[k], 1));
  return result;
}

// The area of each sheet as a skin's joints show it.
std::vector<double> posed_areas(const tinygltf::Model& model, const UsedMesh& mesh, int number, const Use& use,
                                std::span<const glm::dmat4> poses, std::span<const double> weights) {
  std::vector<double> areas;
  const auto& primitives = model.meshes[static_cast<std::size_t>(number)].primitives;
  for (const auto& sheet : mesh.sheets) {
    const Vertices vertices(model, primitives[sheet.primitive],
                            {.node = use.name, .world = use.world, .weights = weights, .poses = poses},
                            sheet.what);
    double area = 0;
    for (const auto& triangle : sheet.triangles) {
      Corners corners;
      for (std::size_t k = 0; k < 3; ++k)
        corners[k] =
            glm::vec3(vertices.transform(triangle[k]).world * glm::dvec4(vertices.position(triangle[k]), 1));
      area += area_of(corners);
    }
    areas.push_back(area);
  }
  return areas;
}

}  // namespace

Meshes used_meshes(const tinygltf::Model& model) {
  Meshes meshes;
  std::size_t triangles_left = max_triangles;
  const auto nodes = place_nodes(model, {});
  Remarks remarks;  // load() tells them
  SkinReader skins(model, nodes, remarks);
  for (const PlacedNode& placed : nodes) {
    const auto& node = model.nodes[static_cast<std::size_t>(placed.node)];
    if (node.mesh == -1 || !placed.visible) continue;
    const std::string name = node_name(model, placed.node);
    const auto& weights =
        node.weights.empty() ? model.meshes[static_cast<std::size_t>(node.mesh)].weights : node.weights;
    auto& mesh = meshes[node.mesh];
    if (mesh.uses.empty()) mesh.sheets = sheets_of(model, node.mesh, name, weights, triangles_left);
    mesh.uses.push_back({placed.node, name, placed.world, density_of(node, name), {}});
    if (node.skin < 0) continue;
    if (const auto poses = skins.poses(node.skin, "node " + in_quotes(name)); !poses.empty())
      mesh.uses.back().posed = posed_areas(model, mesh, node.mesh, mesh.uses.back(), poses, weights);
  }
  return meshes;
}

double area_in_world(const UsedMesh& mesh, std::size_t sheet, const Use& use) {
  const Sheet& of = mesh.sheets[sheet];
  if (!use.posed.empty())  // its backs are as large
    return use.posed[sheet] * static_cast<double>(of.corners.size()) / static_cast<double>(of.fronts);
  double area = 0;
  for (const auto& corners : of.corners) area += area_of(in_world(corners, use.world));
  return area;
}

double scale_of(const UsedMesh& mesh, std::size_t sheet, const Use& use) {
  double inside = 0;
  for (const auto& corners : mesh.sheets[sheet].corners) inside += area_of(corners);
  const double scale = std::sqrt(area_in_world(mesh, sheet, use) / inside) * use.density;
  return std::isfinite(scale) ? scale : 0;
}

std::string fault_of(const Meshes& meshes) {
  std::vector<std::string> without;
  for (const auto& [number, mesh] : meshes)
    for (const auto& sheet : mesh.sheets)
      if (sheet.own.empty()) {
        without.push_back(mesh.uses.front().name);
        break;
      }
  if (!without.empty())
    return "node " + in_quotes(without.front()) +
           (without.size() > 1 ? " and " + std::to_string(without.size() - 1) + " more have" : " has") +
           " no TEXCOORD_1";
  struct Owner {
    const Corners* corners = nullptr;
    const Use* use = nullptr;
  };
  std::vector<Owner> owners(std::size_t{judged_at} * judged_at);
  std::size_t filled = 0, shared = 0, looks = 0;
  double area = 0, flat_area = 0;
  std::map<std::pair<std::string, std::string>, std::size_t> pairs;
  std::string flattest;
  for (const auto& [number, mesh] : meshes)
    for (const auto& use : mesh.uses)
      for (const auto& sheet : mesh.sheets)
        for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
          std::array<glm::dvec2, 3> cells;
          for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec2 at = sheet.own[t][k];
            if (!(glm::distance(at, glm::clamp(at, 0.0f, 1.0f)) <= atlas_rounding))
              return "TEXCOORD_1 of node " + in_quotes(use.name) + " is not within 0..1";
            cells[k] = glm::dvec2(at) * double{judged_at};
          }
          const double of_triangle = area_of(in_world(sheet.corners[t], use.world));
          area += of_triangle;
          const auto flat = FlatTriangle::of(cells);
          if (!flat) {
            flat_area += of_triangle;
            flattest = use.name;
            continue;
          }
          // A texel's hair is nobody's: charts may touch.
          constexpr double margin = 0.05;
          if (looks > most_looks)
            return "triangles of node " + in_quotes(use.name) + " lie on many others in TEXCOORD_1";
          flat->for_cells(margin, judged_at, [&](std::int64_t i, std::int64_t j) {
            ++looks;
            Owner& owner = owners[static_cast<std::size_t>(j * judged_at + i)];
            if (!owner.corners) {
              ++filled;
            } else if (owner.use != &use || !are_copies(*owner.corners, sheet.corners[t])) {
              ++shared;
              ++pairs[std::minmax(owner.use->name, use.name)];
            }
            owner = {&sheet.corners[t], &use};
          });
        }
  if (flat_area > most_flat * area) return "TEXCOORD_1 of node " + in_quotes(flattest) + " has no area";
  if (static_cast<double>(shared) > most_overlap * static_cast<double>(filled)) {
    const auto worst = std::ranges::max_element(pairs, {}, [](const auto& pair) { return pair.second; })->first;
    return worst.first == worst.second ? "charts of node " + in_quotes(worst.first) + " overlap in TEXCOORD_1"
                                       : "charts of nodes " + in_quotes(worst.first) + " and " +
                                             in_quotes(worst.second) + " overlap in TEXCOORD_1";
  }
  return "";
}

void add_backs(Meshes& meshes) {
  const bool any = std::ranges::any_of(
      meshes, [](const auto& entry) { return std::ranges::any_of(entry.second.sheets, &Sheet::double_sided); });
  if (!any) return;
  const BodiesInSpace bodies(meshes);
  for (auto& [number, mesh] : meshes) {
    std::size_t first = 0;
    for (auto& sheet : mesh.sheets) {
      for (std::size_t t = 0; t < sheet.fronts && sheet.double_sided; ++t) {
        if (bodies.is_solid_alone(number, first + t)) continue;
        const auto [a, b, c] = sheet.triangles[t];
        const auto& at = sheet.corners[t];
        sheet.corners.push_back({at[0], at[2], at[1]});
        sheet.triangles.push_back({a, c, b});
      }
      first += sheet.fronts;
    }
  }
}

}  // namespace lichtveld::scene
