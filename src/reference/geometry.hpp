// The scene as the paths see it: bodies at their places, everything scaled into the unit sphere (irradiance
// does not depend on that scale, and rounding and epsilons become the same for every scene).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lichtveld/scene/surface_point.hpp"

namespace lichtveld::reference {

using Hit = scene::SurfacePoint;

// A place that light is gathered at, on the side that `normal` and `face` point to.
struct Receiver {
  glm::vec3 position;  // a hair off the surface
  glm::vec3 normal;    // unit: the interpolated NORMAL, about which light is weighed
  glm::vec3 face;      // unit: the triangle's own, on the same side; nothing arrives from below it
  std::uint32_t triangle;
};

class Geometry {
 public:
  // The scene must outlive it.
  Geometry(const scene::Scene& scene, const std::vector<glm::vec3>& offsets);

  std::uint32_t triangles() const { return static_cast<std::uint32_t>(faces_.size()); }
  const std::vector<glm::vec3>& positions() const { return positions_; }  // of Scene::vertices
  const std::vector<std::uint32_t>& indices() const { return scene_.indices; }

  const scene::Scene& scene() const { return scene_; }
  // Of its own coordinates, in which the scene fills the unit sphere: where that is in the scene's, and how
  // long one is there [m].
  glm::vec3 in_scene(const glm::vec3& place) const { return sphere_.centre + sphere_.radius * place; }
  float metres() const { return sphere_.radius; }
  // Of a body [m].
  glm::vec3 offset(std::uint32_t body) const { return body < offsets_.size() ? offsets_[body] : glm::vec3(0); }
  const scene::Material& material(std::uint32_t triangle) const;
  // Unit; the front is where the corners are seen counter-clockwise.
  const glm::vec3& face(std::uint32_t triangle) const { return faces_[triangle]; }
  float area(std::uint32_t triangle) const;
  glm::vec3 position(const Hit& hit) const;
  glm::vec3 albedo(const Hit& hit) const;  // 0..1, linear

  bool shows_front(std::uint32_t triangle, const glm::vec3& ray) const {
    return glm::dot(faces_[triangle], ray) < 0;
  }
  // For rays along there the triangle does not exist: the back of a one-sided surface.
  bool is_transparent(std::uint32_t triangle, const glm::vec3& ray) const {
    return !shows_front(triangle, ray) && !material(triangle).double_sided;
  }

  // The texel's rule: light is received on the side of the NORMAL.
  Receiver receiver(const Hit& hit) const;
  // What a ray along `direction` has hit: of double-sided surfaces the side that it came from.
  Receiver receiver_seen(const Hit& hit, const glm::vec3& direction) const;

 private:
  Receiver receiver(const Hit& hit, const glm::vec3& normal) const;
  glm::vec3 normal(const Hit& hit) const;  // interpolated, unit
  const scene::Vertex& vertex(std::uint32_t triangle, std::uint32_t corner) const {
    return scene_.vertices[scene_.indices[std::size_t{3} * triangle + corner]];
  }
  const glm::vec3& corner(std::uint32_t triangle, std::uint32_t corner) const {
    return positions_[scene_.indices[std::size_t{3} * triangle + corner]];
  }

  const scene::Scene& scene_;
  const scene::Offsets offsets_;
  const scene::Sphere sphere_;
  std::vector<glm::vec3> positions_;
  std::vector<glm::vec3> faces_;
  std::vector<std::uint32_t> materials_;  // of each triangle
};

}  // namespace lichtveld::reference
