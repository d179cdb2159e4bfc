// What of a scene shines: lamps, each a few polygons, with points on them for shadows.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

// Part of a lamp: a triangle, or a parallelogram, which starts at `corner` and is spanned by u and v.
struct LampPatch {
  glm::vec3 corner, u, v;  // [m], bodies at rest; the front is where u, v turn counter-clockwise
  glm::vec3 emission;      // Le [W m^-2 sr^-1]
  bool triangle, double_sided;
};

// E [W m^-2] that a patch brings to a place without anything in between; nothing arrives from below `normal` or
// `face`.
glm::vec3 irradiance_of(const LampPatch& patch, const glm::vec3& place, const glm::vec3& normal,
                        const glm::vec3& face);

constexpr std::uint32_t samples_of_lamp = 64;

// Points on a lamp, each of which stands for as much of its power: area times mean radiance.
struct LampSamples {
  std::array<float, samples_of_lamp> x, y, z, nx, ny, nz;  // place and front, bodies at rest [m]
  std::array<float, samples_of_lamp> back;           // -1 where it shines from its back, too, and 0 where not
  std::array<glm::vec3, samples_of_lamp> intensity;  // area * Le that it stands for [W sr^-1]
};

struct AreaLamp {
  std::uint32_t body = 0;
  std::vector<LampPatch> patches = {};
  scene::Box box = {};  // of the patches [m]
  LampSamples samples = {};
};

// What hangs together of the triangles that emit, of one body; a triangle that is written twice shines once. If
// there are more than `most`, those that lie near each other are one, always the same ones.
std::vector<AreaLamp> find_area_lamps(const scene::Scene& scene, std::size_t most);

}  // namespace lichtveld::lightfield
