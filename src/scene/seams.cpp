#include "lichtveld/scene/seams.hpp"

#include <algorithm>
#include <utility>

#include "unwrap/welding.hpp"

namespace lichtveld::scene {

namespace {

// Corners of several nodes that are at one place differ by rounding [radii of the scene].
constexpr float same_place = 2e-5f;
// NORMALs that are turned against each other by more, 8 degrees, are a crease.
constexpr float smooth_cosine = 0.99f;
constexpr float same_coordinates = 1e-6f;       // of the atlas
constexpr std::ptrdiff_t most_on_an_edge = 16;  // triangles that are looked at for one that goes on

struct HalfEdge {
  std::uint64_t ends;  // numbers of the places, the lower one in front; with `body` what it is known by
  std::uint32_t body, triangle;
  std::uint32_t from, to;  // vertices, in the order of `ends`

  auto key() const { return std::pair(body, ends); }
};

std::vector<HalfEdge> half_edges(const Scene& scene) {
  const float step = same_place * bounding_sphere(scene).radius;
  Numbers<3> numbers;
  std::vector<std::uint32_t> place;
  place.reserve(scene.vertices.size());
  for (const auto& vertex : scene.vertices) {
    const glm::vec3 rounded = glm::round(vertex.position / step);
    place.push_back(numbers.of({rounded.x, rounded.y, rounded.z}));
  }
  std::vector<HalfEdge> edges;
  edges.reserve(scene.indices.size());
  for (std::size_t i = 0; i < scene.indices.size(); ++i) {
    const std::size_t triangle = i / 3;
    std::uint32_t from = scene.indices[i], to = scene.indices[3 * triangle + (i + 1) % 3];
    if (place[from] == place[to]) continue;
    if (place[from] > place[to]) std::swap(from, to);
    edges.push_back({std::uint64_t{place[from]} << 32 | place[to], scene.vertices[from].body,
                     static_cast<std::uint32_t>(triangle), from, to});
  }
  return edges;
}

bool meet(const Scene& scene, const HalfEdge& a, const HalfEdge& b) {
  const auto alike = [&](std::uint32_t one, std::uint32_t other) {
    return glm::dot(scene.vertices[one].normal, scene.vertices[other].normal) >= smooth_cosine;
  };
  const auto apart = [&](std::uint32_t one, std::uint32_t other) {
    const glm::vec2 way = glm::abs(scene.vertices[one].atlas - scene.vertices[other].atlas);
    return std::max(way.x, way.y) > same_coordinates;
  };
  return alike(a.from, b.from) && alike(a.to, b.to) && (apart(a.from, b.from) || apart(a.to, b.to));
}

}  // namespace

std::vector<Seam> find_seams(const Scene& scene) {
  auto edges = half_edges(scene);
  std::ranges::sort(edges, {}, [](const HalfEdge& edge) { return std::pair(edge.key(), edge.triangle); });
  std::vector<Seam> seams;
  const auto side = [&](const HalfEdge& edge) {
    return Seam::Side{edge.triangle, scene.vertices[edge.from].atlas, scene.vertices[edge.to].atlas};
  };
  for (auto first = edges.begin(); first != edges.end();) {
    const auto end =
        std::find_if(first, edges.end(), [&](const HalfEdge& edge) { return edge.key() != first->key(); });
    // Each with the next one that goes on from it, so that many on one edge are no square of them.
    for (auto one = first; one != end; ++one) {
      const auto last = end - one > most_on_an_edge ? one + most_on_an_edge : end;
      const auto other =
          std::find_if(one + 1, last, [&](const HalfEdge& edge) { return meet(scene, *one, edge); });
      if (other == last) continue;
      seams.push_back(
          {scene.vertices[one->from].position, scene.vertices[one->to].position, {side(*one), side(*other)}});
    }
    first = end;
  }
  std::ranges::sort(seams, {}, [](const Seam& seam) { return seam.sides[0].triangle; });
  return seams;
}

}  // namespace lichtveld::scene
