#include "geometry.hpp"

#include <algorithm>

namespace lichtveld::reference {
namespace {

// Places are moved this far towards the middle of their triangle, and receivers lifted half as far off it: a
// path that starts on an edge shared with a wall could, by rounding, start behind that wall. Coordinates in the
// unit sphere are rounded by up to 6e-8.
constexpr float inset = 2e-6f;
constexpr float lift = 1e-6f;

}  // namespace

Geometry::Geometry(const scene::Scene& scene, const std::vector<glm::vec3>& offsets)
    : scene_(scene), offsets_(offsets), sphere_(scene::bounding_sphere(scene, offsets)) {
  positions_.reserve(scene.vertices.size());
  for (const scene::Vertex& vertex : scene.vertices) {
    const glm::dvec3 offset = this->offset(vertex.body);
    positions_.emplace_back((glm::dvec3(vertex.position) + offset - glm::dvec3(sphere_.centre)) /
                            double{sphere_.radius});
  }
  faces_.resize(scene.indices.size() / 3);
  materials_.resize(faces_.size());
  for (const scene::Surface& surface : scene.surfaces)
    for (std::uint32_t i = 0; i < surface.index_count; i += 3) {
      const std::uint32_t triangle = (surface.first_index + i) / 3;
      const glm::dvec3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
      const glm::dvec3 cross = glm::cross(b - a, c - a);
      const double length = glm::length(cross);
      // Scaling can round a sliver to nothing; no ray hits it then.
      faces_[triangle] = length > 0 ? glm::vec3(cross / length) : glm::vec3(0, 1, 0);
      materials_[triangle] = surface.material;
    }
}

const scene::Material& Geometry::material(std::uint32_t triangle) const {
  return scene_.materials[materials_[triangle]];
}

float Geometry::area(std::uint32_t triangle) const {
  const glm::dvec3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
  return static_cast<float>(glm::length(glm::cross(b - a, c - a)) / 2);
}

glm::vec3 Geometry::position(const Hit& hit) const {
  const glm::vec3 w = scene::weights(hit);
  const glm::vec3 &a = corner(hit.triangle, 0), &b = corner(hit.triangle, 1), &c = corner(hit.triangle, 2);
  const glm::vec3 at = w.x * a + w.y * b + w.z * c, to_middle = (a + b + c) / 3.0f - at;
  return at + to_middle * (inset / std::max(glm::length(to_middle), inset));
}

glm::vec3 Geometry::albedo(const Hit& hit) const {
  return scene::albedo_at(scene_, material(hit.triangle), hit);
}

glm::vec3 Geometry::normal(const Hit& hit) const {
  const glm::vec3 w = scene::weights(hit);
  const glm::vec3 sum = w.x * vertex(hit.triangle, 0).normal + w.y * vertex(hit.triangle, 1).normal +
                        w.z * vertex(hit.triangle, 2).normal;
  const float length = glm::length(sum);
  return length > 0 ? sum / length : faces_[hit.triangle];
}

Receiver Geometry::receiver(const Hit& hit) const {
  return receiver(hit, normal(hit));
}

Receiver Geometry::receiver_seen(const Hit& hit, const glm::vec3& direction) const {
  const glm::vec3 facing = normal(hit);
  const bool from_behind =
      material(hit.triangle).double_sided &&
      glm::dot(facing, faces_[hit.triangle]) * glm::dot(faces_[hit.triangle], direction) > 0;
  return receiver(hit, from_behind ? -facing : facing);
}

Receiver Geometry::receiver(const Hit& hit, const glm::vec3& normal) const {
  const glm::vec3 face =
      glm::dot(normal, faces_[hit.triangle]) < 0 ? -faces_[hit.triangle] : faces_[hit.triangle];
  return {position(hit) + lift * face, normal, face, hit.triangle};
}

}  // namespace lichtveld::reference
