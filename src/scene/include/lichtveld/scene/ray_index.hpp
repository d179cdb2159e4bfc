// What rays meet: what stands still, and each body in its own space, in a tree each that is never built again.
// A body that moves is looked for where it is by shifting the rays, so that its place costs nothing.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {

// Rays that are followed together, best of nearly the same direction and from places near each other.
struct RayPacket {
  static constexpr std::uint32_t size = 16;
  using Lanes = std::array<float, size>;
  alignas(64) Lanes x, y, z;        // where they start, world space [m]
  alignas(64) Lanes dx, dy, dz;     // where to; not of unit length by need
  alignas(64) std::uint32_t lanes;  // a bit for each ray that there is

  void set(std::uint32_t lane, const glm::vec3& from, const glm::vec3& direction) {
    x[lane] = from.x, y[lane] = from.y, z[lane] = from.z;
    dx[lane] = direction.x, dy[lane] = direction.y, dz[lane] = direction.z;
  }
};

// What each ray of a packet meets first.
struct HitPacket {
  static constexpr std::uint32_t none = ~0u;
  alignas(64) RayPacket::Lanes distance;                            // in lengths of the ray's direction
  alignas(64) std::array<std::uint32_t, RayPacket::size> triangle;  // of Scene::indices, or none
  alignas(64) RayPacket::Lanes u, v;  // barycentric, of the triangle's second and third corner
  std::uint32_t from_behind;          // a bit for each ray that meets a (double-sided) triangle's back

  // Nothing yet: rays look as far as `reach`.
  void clear(float reach) {
    distance.fill(reach);
    triangle.fill(none);
    from_behind = 0;
  }
};

class RayIndex {
 public:
  // Of every body at rest. The scene must outlive it. Throws std::runtime_error where memory does not suffice.
  explicit RayIndex(const Scene& scene);
  ~RayIndex();

  // How far from a surface what lies on it may be found, for rounding [m]; rays that leave a surface start half
  // as far above it, or they would meet it.
  float skin() const { return skin_; }

  // The nearest surface of one body, shifted by `offset` from rest [m], that is nearer than `hits` says; those
  // are replaced. A one-sided triangle is there from its front alone.
  void nearest(std::uint32_t body, const glm::vec3& offset, const RayPacket& rays, HitPacket& hits) const;

  // A bit for each ray that meets the body within `reach` lengths of its direction.
  std::uint32_t occluded(std::uint32_t body, const glm::vec3& offset, const RayPacket& rays, float reach) const;

  // Of rays of unit length a bit for each that first meets a front of that body, or a back. A double-sided
  // triangle has two fronts, and so have two faces on each other that look both ways.
  struct Sides {
    std::uint32_t fronts = 0, backs = 0;
  };
  Sides sides_met(std::uint32_t body, const glm::vec3& offset, const RayPacket& rays) const;

  // Whether anything of a triangle's own body may lie above it, on the side that `face` (unit) looks to: if
  // not, no ray that leaves it there meets that body. Of boxes and what else is convex nothing does.
  bool may_meet_own_body(std::uint32_t triangle, const glm::vec3& face) const;

  // Whether a surface of that body lies on the place and looks at it, so that nothing else can be seen from
  // there, and is not the other side of the same sheet (of_one_node). Place and face (unit) are of that
  // triangle, which is not found itself.
  bool contact(std::uint32_t body, const glm::vec3& offset, const glm::vec3& place, const glm::vec3& face,
               std::uint32_t triangle) const;

 private:
  struct Trees;
  // The same; with `backs` of one-sided triangles, too.
  void nearest(std::uint32_t body, const glm::vec3& offset, const RayPacket& rays, HitPacket& hits,
               bool backs) const;

  const Scene& scene_;
  std::unique_ptr<Trees> trees_;
  glm::vec3 centre_;
  float skin_;
};

}  // namespace lichtveld::scene
