// What of a scene gives light.
#pragma once

#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {

// The triangles of Scene::indices whose material emits, in their order.
std::vector<std::uint32_t> emitting_triangles(const Scene& scene);

// Whether anything does: a material, a punctual light, the sky.
bool has_light(const Scene& scene);

// All as in the file.
Scales full(const Scene& scene);

// The scene with its lights scaled so for good.
Scene dimmed(Scene scene, const Scales& scales);

// E [W m^-2] that a punctual light brings to a place without anything in between, its body shifted by `offset`
// [m]; nothing arrives from below `normal` or `face` (unit). Spots fade between their cones and all fade
// towards their range as in three.js.
glm::vec3 irradiance_of(const PunctualLight& light, const glm::vec3& offset, const glm::vec3& place,
                        const glm::vec3& normal, const glm::vec3& face);

// What a point or a spot gives in all directions [W]; 0 of a directional one, which has no end.
glm::vec3 flux_of(const PunctualLight& light);

// L [W m^-2 sr^-1] of the sky as it is seen along a unit vector.
glm::vec3 radiance_of(const Sky& sky, const glm::vec3& direction);
// Along which the middle of a pixel is seen, unit; and how much of the sphere one of that row is [sr].
glm::vec3 direction_of(const Sky& sky, std::uint32_t column, std::uint32_t row);
float solid_angle_of(const Sky& sky, std::uint32_t row);

// Of all of it, by the solid angle.
glm::vec3 mean_radiance(const Sky& sky);

// E [W m^-2] of level ground that sees nothing else.
glm::vec3 irradiance_of(const Sky& sky);

// The way from a place to a light's middle, or for a directional one against its direction, unit.
glm::vec3 towards(const PunctualLight& light, const glm::vec3& offset, const glm::vec3& place);

}  // namespace lichtveld::scene
