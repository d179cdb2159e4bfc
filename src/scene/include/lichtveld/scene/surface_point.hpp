// A place on the surfaces, and what is there.
#pragma once

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {

struct SurfacePoint {
  std::uint32_t triangle;  // of Scene::indices
  glm::vec2 barycentric;   // weighs the triangle's second and third corner
};

// The point, or one in the triangle where it lies outside.
SurfacePoint pulled_inside(const SurfacePoint& point);

// Of the three corners; they sum to 1.
glm::vec3 weights(const SurfacePoint& point);

// Where a triangle of Scene::indices looks.
struct Facing {
  glm::vec3 face;  // unit, its own normal, on the side to which its NORMALs point; 0 where it has no area
  bool turned;     // against the order of its corners
};
Facing facing_of(const Scene& scene, std::uint32_t triangle);

// Linear RGB, decoded from sRGB before the bilinear filter, as graphics hardware does it. `at` is glTF's
// texture coordinate: (0, 0) is the upper left corner of the first pixel.
glm::vec3 sample_srgb(const Texture& texture, glm::vec2 at, std::array<Wrap, 2> wrap = {});

// Its alpha there, 0..1.
float sample_alpha(const Texture& texture, glm::vec2 at, std::array<Wrap, 2> wrap = {});

// What a surface of that material reflects there: 0..1, linear.
glm::vec3 albedo_at(const Scene& scene, const Material& material, const SurfacePoint& point);

}  // namespace lichtveld::scene
