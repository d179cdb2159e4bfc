// Swept boxes against triangles and boxes by separating axes: two convex bodies overlap while their shadows
// overlap on every axis of a finite set (box and triangle: Akenine-Moeller, Fast 3D Triangle-Box Overlap
// Testing, JGT 2001). A body that moves evenly overlaps on one axis during one interval of time, so their
// intersection is the exact time of overlap (Gottschalk, Lin, Manocha, OBBTree, SIGGRAPH 1996, has the static
// test): no wall is too thin.
#include "lichtveld/scene/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace lichtveld::scene {
namespace {

// Boxes are shrunken by this share of a step on each side, so that touching is no overlap. It is far above the
// rounding of 32-bit places and far below what a player sees.
constexpr double skin_share = 1e-3;

struct Mover {
  glm::dvec3 centre, half, step;  // of the shrunken box; step and all lengths in metres
  double skin;
};

struct Interval {
  double min, max;
};

// Follows a mover along one obstacle's axes.
class Sweep {
 public:
  explicit Sweep(const Mover& mover) : mover_(mover) {}

  // The obstacle's shadow on an axis of any length.
  void axis(glm::dvec3 direction, std::span<const glm::dvec3> corners) {
    const double length = glm::length(direction);
    if (length < 1e-9) return;  // parallel edges: other axes decide
    direction /= length;
    Interval shadow{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
    for (const glm::dvec3& corner : corners) {
      const double at = glm::dot(direction, corner - mover_.centre);
      shadow = {std::min(shadow.min, at), std::max(shadow.max, at)};
    }
    const double reach = glm::dot(glm::abs(direction), mover_.half), speed = glm::dot(direction, mover_.step);
    // The mover's shadow is speed * t -/+ reach; they overlap while low < speed * t < high.
    const double low = shadow.min - reach, high = shadow.max + reach;
    if (std::abs(speed) < 1e-12) {
      if (low >= 0 || high <= 0) enter_ = std::numeric_limits<double>::infinity();
    } else {
      enter_ = std::max(enter_, std::min(low / speed, high / speed));
      leave_ = std::min(leave_, std::max(low / speed, high / speed));
    }
    // The nearest way out of an overlap on this axis, and whether the step goes the other way.
    const double ahead = high, behind = -low, depth = std::min(ahead, behind);
    if (depth < depth_) {
      depth_ = depth;
      deepens_ = (ahead < behind && speed < 0) || (behind < ahead && speed > 0);
    }
  }

  // The share of the step before the overlap begins. In an overlap from the start, only what deepens it is
  // refused.
  double free_share() const {
    if (enter_ >= leave_ || enter_ >= 1 || leave_ <= 0) return 1;
    if (enter_ >= 0) return std::max(0.0, enter_ - mover_.skin / glm::length(mover_.step));
    return deepens_ ? 0 : 1;
  }

 private:
  const Mover& mover_;
  double enter_ = -std::numeric_limits<double>::infinity(), leave_ = std::numeric_limits<double>::infinity();
  double depth_ = std::numeric_limits<double>::max();
  bool deepens_ = false;
};

constexpr std::array<glm::dvec3, 3> scene_axes = {glm::dvec3{1, 0, 0}, glm::dvec3{0, 1, 0},
                                                  glm::dvec3{0, 0, 1}};

double free_share(const Mover& mover, const std::array<glm::dvec3, 3>& triangle) {
  const std::array edges = {triangle[1] - triangle[0], triangle[2] - triangle[1], triangle[0] - triangle[2]};
  Sweep sweep(mover);
  sweep.axis(glm::cross(edges[0], edges[1]), triangle);
  for (const glm::dvec3& axis : scene_axes) {
    sweep.axis(axis, triangle);
    for (const glm::dvec3& edge : edges) sweep.axis(glm::cross(axis, edge), triangle);
  }
  return sweep.free_share();
}

double free_share(const Mover& mover, const Box& box, const glm::dvec3& offset) {
  const std::array corners = {glm::dvec3(box.min) + offset, glm::dvec3(box.max) + offset};
  Sweep sweep(mover);
  for (const glm::dvec3& axis : scene_axes) sweep.axis(axis, corners);
  return sweep.free_share();
}

}  // namespace

float step_length(const Scene& scene) {
  return bounding_sphere(scene).radius / 32;
}

glm::vec3 free_step(const Scene& scene, const Offsets& offsets, std::uint32_t body, glm::vec3 step) {
  const float length = glm::length(step);
  if (!std::isfinite(length) || length == 0) return glm::vec3(0);

  const Box& box = scene.bodies.at(body).box;
  const glm::dvec3 centre = (glm::dvec3(box.min) + glm::dvec3(box.max)) / 2.0 + glm::dvec3(offsets.at(body));
  const double skin = skin_share * step_length(scene);
  const glm::dvec3 half = glm::max((glm::dvec3(box.max) - glm::dvec3(box.min)) / 2.0 - skin, glm::dvec3(0));
  const Mover mover{centre, half, step, skin};

  double share = 1;
  const glm::dvec3 low = glm::min(centre, centre + mover.step) - half,
                   high = glm::max(centre, centre + mover.step) + half;
  for (const Surface& surface : scene.surfaces) {
    if (surface.body != 0) continue;
    for (std::uint32_t t = 0; t < surface.index_count; t += 3) {
      std::array<glm::dvec3, 3> p;
      for (std::uint32_t k = 0; k < 3; ++k)
        p[k] = scene.vertices[scene.indices[surface.first_index + t + k]].position;
      const bool far = glm::any(glm::greaterThan(glm::min(p[0], glm::min(p[1], p[2])), high)) ||
                       glm::any(glm::lessThan(glm::max(p[0], glm::max(p[1], p[2])), low));
      if (!far) share = std::min(share, free_share(mover, p));
    }
  }
  for (std::size_t other = 1; other < scene.bodies.size(); ++other) {
    if (other != body) share = std::min(share, free_share(mover, scene.bodies[other].box, offsets.at(other)));
  }
  return step * static_cast<float>(share);
}

}  // namespace lichtveld::scene
