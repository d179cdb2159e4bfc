// Finds what a ray hits, with Embree.
#pragma once

#include <memory>
#include <optional>

#include "geometry.hpp"
#include "lichtveld/scene/embree.hpp"

namespace lichtveld::reference {

class EmbreeScene {
 public:
  // The geometry must outlive it. Throws std::runtime_error if there is not enough memory.
  explicit EmbreeScene(const Geometry& geometry);

  // The nearest surface from there along a unit direction on the receiver's side of its face. One-sided
  // surfaces are there from their front alone, and a receiver never sees its own triangle. What lies on
  // the receiver is in front of it, unless it is the other side of its sheet.
  std::optional<Hit> nearest(const Receiver& from, const glm::vec3& direction) const;

 private:
  // Whether a triangle that lies on the receiver is the other side of its sheet: of the same node, and nothing
  // is left going on from there.
  bool is_one_sheet(const Receiver& from, std::uint32_t triangle) const;

  const Geometry& geometry_;
  scene::EmbreeDevice device_;
  scene::EmbreeTree scene_;
};

}  // namespace lichtveld::reference
