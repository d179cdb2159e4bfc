// What the meshes of a file are: open or closed, and which way they face.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "load_report.hpp"
#include "parts.hpp"
#include "unwrap/bodies_in_space.hpp"

namespace lichtveld::scene {
namespace {

// A triangle by its corners in ascending order, and whether that runs round it the other way.
struct Face {
  Places corners;
  bool turned;
  auto operator<=>(const Face&) const = default;
};

// The sides of each place where triangles lie: a triangle, its back, or both.
struct Side {
  Places corners;
  bool front = false, back = false;
};

std::vector<Side> sides_of(std::span<const Places> places) {
  std::vector<Face> faces;
  for (Places p : places) {
    if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) continue;  // no area
    bool turned = false;
    for (const auto& [i, j] : {std::pair{0u, 1u}, {1u, 2u}, {0u, 1u}})
      if (p[i] > p[j]) {
        std::swap(p[i], p[j]);
        turned = !turned;
      }
    faces.push_back({p, turned});
  }
  std::ranges::sort(faces);
  std::vector<Side> sides;
  for (const auto& [corners, turned] : faces) {
    if (sides.empty() || sides.back().corners != corners) sides.push_back({.corners = corners});
    (turned ? sides.back().back : sides.back().front) = true;
  }
  return sides;
}

void count_edges(std::span<const Places> places, MeshFacts& facts) {
  struct Edge {
    std::uint64_t ends;
    bool there, back;  // whether a triangle runs from the lower end to the higher, and the other way
    auto operator<=>(const Edge&) const = default;
  };
  std::vector<Edge> edges;
  for (const auto& [p, front, back] : sides_of(places))
    for (const auto& [i, j] : {std::pair{0u, 1u}, {1u, 2u}, {0u, 2u}}) {
      const bool along = j != 2 || i != 0;  // the last edge is run from its higher end
      edges.push_back({std::uint64_t{p[i]} << 32 | p[j], along ? front : back, along ? back : front});
    }
  std::ranges::sort(edges);
  for (auto first = edges.begin(), end = first; first != edges.end(); first = end) {
    end = std::find_if(first, edges.end(), [&](const Edge& edge) { return edge.ends != first->ends; });
    const auto count = end - first;
    const auto& last = *(end - 1);
    if (count == 1 && first->there != first->back) ++facts.boundary_edges;
    if (count > 2) ++facts.non_manifold_edges;
    if (count == 2 && first->there != first->back && first->there == last.there && first->back == last.back)
      ++facts.flipped_edges;
  }
}

bool emits(const tinygltf::Model& model, int material) {
  if (material < 0 || static_cast<std::size_t>(material) >= model.materials.size()) return false;
  const auto& factor = model.materials[static_cast<std::size_t>(material)].emissiveFactor;
  return std::ranges::any_of(factor, [](double channel) { return channel > 0; });
}

void look_at_bodies(const tinygltf::Model& model, int number, const UsedMesh& mesh,
                    const BodiesInSpace& in_space, MeshFacts& facts) {
  // Flatter than this share of its length, it is a sheet of two faces.
  constexpr double flat = 1e-6;
  const auto& bodies = in_space.of(number);
  struct OfBody {
    double area = 0;
    bool dark = false, shines = false, two_sided = false;
  };
  std::vector<OfBody> of(bodies.closed.size());
  std::size_t first = 0;
  for (const auto& sheet : mesh.sheets) {
    const bool shines =
        emits(model, model.meshes[static_cast<std::size_t>(number)].primitives[sheet.primitive].material);
    for (std::size_t t = 0; t < sheet.fronts; ++t) {
      auto& body = of[bodies.of[first + t]];
      body.area += area_of(sheet.corners[t]);
      (shines ? body.shines : body.dark) = true;
      body.two_sided |= sheet.double_sided;
    }
    first += sheet.fronts;
  }
  for (std::size_t body = 0; body < of.size(); ++body) {
    const double length = glm::distance(bodies.min[body], bodies.max[body]);
    if (!bodies.closed[body] || !(std::abs(bodies.volume[body]) > flat * length * of[body].area)) continue;
    ++facts.closed_bodies;
    // A room that shines here and there needs nothing in it.
    const bool is_room = of[body].shines && of[body].dark;
    if (bodies.volume[body] < 0 && !of[body].two_sided && !is_room && in_space.is_alone(number, body))
      ++facts.inside_out;
  }
}

// Where lights without a surface stand, which may be all that a room holds.
std::vector<glm::vec3> places_of_lights(const tinygltf::Model& model) {
  std::vector<glm::vec3> places;
  for (const auto& placed : place_nodes(model, {}))
    if (model.nodes[static_cast<std::size_t>(placed.node)].extensions.contains("KHR_lights_punctual"))
      places.emplace_back(placed.world[3]);
  return places;
}

double area_of_all(const UsedMesh& mesh) {
  double area = 0;
  for (std::size_t s = 0; s < mesh.sheets.size(); ++s)
    if (mesh.sheets[s].double_sided)
      for (const auto& use : mesh.uses) area += area_in_world(mesh, s, use);
  return area;
}

}  // namespace

std::vector<MeshFacts> mesh_facts(const tinygltf::Model& model) {
  Meshes meshes = used_meshes(model);
  std::vector<MeshFacts> all;
  std::vector<double> areas;
  {
    const BodiesInSpace bodies(meshes, places_of_lights(model));
    for (const auto& [number, mesh] : meshes) {
      MeshFacts facts{.node = mesh.uses.front().name, .nodes = mesh.uses.size()};
      for (const auto& sheet : mesh.sheets) facts.triangles += sheet.fronts;
      facts.double_sided = !mesh.sheets.empty() && std::ranges::all_of(mesh.sheets, &Sheet::double_sided);
      count_edges(bodies.places_of(number), facts);
      look_at_bodies(model, number, mesh, bodies, facts);
      areas.push_back(area_of_all(mesh));
      all.push_back(std::move(facts));
    }
  }
  add_backs(meshes);
  std::size_t i = 0;
  for (const auto& [number, mesh] : meshes) {
    for (const auto& sheet : mesh.sheets) all[i].two_faced += sheet.corners.size() - sheet.fronts;
    if (all[i].two_faced > 0) all[i].two_faced_area = area_of_all(mesh) - areas[i];
    ++i;
  }
  return all;
}

}  // namespace lichtveld::scene
