#include "lichtveld/scene/walls.hpp"

#include <algorithm>
#include <array>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <optional>
#include <utility>

namespace lichtveld::scene {
namespace {

// Neighbours that bend by less are one curved surface: cosine of 45 degrees.
constexpr float smooth_cosine = 0.7071f;

struct Triangle {
  std::array<glm::dvec3, 3> corners;
  glm::dvec3 normal;  // unit, on the side that light is received on; zero if the triangle has no area
  Box box;
};

Triangle triangle_at(const Scene& scene, const std::vector<glm::vec3>& offsets, std::size_t index) {
  Triangle triangle{};
  glm::dvec3 facing(0);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vertex& vertex = scene.vertices[scene.indices[3 * index + k]];
    triangle.corners[k] = glm::dvec3(vertex.position) + glm::dvec3(offsets[vertex.body]);
    facing += glm::dvec3(vertex.normal);
  }
  const auto& [a, b, c] = triangle.corners;
  const glm::dvec3 cross = glm::cross(b - a, c - a);
  const double length = glm::length(cross);
  if (length > 0) triangle.normal = cross / (glm::dot(cross, facing) < 0 ? -length : length);
  triangle.box = {glm::vec3(glm::min(a, glm::min(b, c))), glm::vec3(glm::max(a, glm::max(b, c)))};
  return triangle;
}

// Where `other` leaves the plane of `floor`.
std::optional<Wall> wall_on(const Triangle& floor, const Triangle& other, double gap) {
  std::array<double, 3> height;
  for (std::size_t k = 0; k < 3; ++k) {
    height[k] = glm::dot(floor.normal, other.corners[k] - floor.corners[0]);
    if (std::abs(height[k]) <= gap) height[k] = 0;
  }
  const auto [lowest, highest] = std::minmax({height[0], height[1], height[2]});
  if (lowest > 0 || highest < 0 || (lowest == 0 && highest == 0)) return std::nullopt;
  std::array<glm::dvec3, 2> ends;
  std::size_t found = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    std::optional<double> at;  // along the edge to the next corner
    if (height[k] == 0)
      at = 0;
    else if ((height[k] < 0) != (height[next] < 0) && height[next] != 0)
      at = height[k] / (height[k] - height[next]);
    if (at && found < 2) ends[found++] = glm::mix(other.corners[k], other.corners[next], *at);
  }
  if (found < 2) return std::nullopt;
  // A gap below it does not put the line beside the plane.
  for (auto& end : ends) end -= floor.normal * glm::dot(floor.normal, end - floor.corners[0]);
  const glm::dvec3 inside = (floor.corners[0] + floor.corners[1] + floor.corners[2]) / 3.0;
  if (glm::dot(glm::cross(floor.normal, ends[1] - ends[0]), inside - ends[0]) < 0) std::swap(ends[0], ends[1]);
  return Wall{glm::vec3(ends[0]), glm::vec3(ends[1]), highest > 0};
}

namespace index = boost::geometry::index;
using Corner = boost::geometry::model::point<float, 3, boost::geometry::cs::cartesian>;
using Region = boost::geometry::model::box<Corner>;

Region grown(const Box& box, float by) {
  return {{box.min.x - by, box.min.y - by, box.min.z - by}, {box.max.x + by, box.max.y + by, box.max.z + by}};
}

}  // namespace

Walls find_walls(const Scene& scene, const std::vector<glm::vec3>& offsets, float gap, float reach) {
  std::vector<Triangle> triangles;
  for (std::size_t index = 0; index < scene.indices.size() / 3; ++index)
    triangles.push_back(triangle_at(scene, offsets, index));
  std::vector<std::pair<Region, std::uint32_t>> regions;
  for (const Triangle& triangle : triangles)
    regions.emplace_back(grown(triangle.box, 0), static_cast<std::uint32_t>(regions.size()));
  const index::rtree<std::pair<Region, std::uint32_t>, index::linear<16>> tree(regions);

  std::vector<std::uint32_t> near;
  Walls walls;
  walls.first.push_back(0);
  for (const Triangle& floor : triangles) {
    near.clear();
    const Region region = grown(floor.box, reach);
    if (floor.normal != glm::dvec3(0))
      for (auto found = tree.qbegin(index::intersects(region)); found != tree.qend(); ++found)
        near.push_back(found->second);
    std::ranges::sort(near);  // however the tree was made
    for (const auto number : near) {
      const Triangle& other = triangles[number];
      if (glm::dot(floor.normal, other.normal) > smooth_cosine) continue;
      const auto wall = wall_on(floor, other, gap);
      if (wall && boost::geometry::intersects(
                      region, grown({glm::min(wall->a, wall->b), glm::max(wall->a, wall->b)}, 0)))
        walls.lines.push_back(*wall);
    }
    walls.first.push_back(static_cast<std::uint32_t>(walls.lines.size()));
  }
  return walls;
}

}  // namespace lichtveld::scene
