// What of a scene shines: lamps, each a few polygons, a punctual light or a part of the sky, with points on
// them for shadows.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
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
  std::array<float, samples_of_lamp> x{}, y{}, z{}, nx{}, ny{}, nz{};  // place and front, bodies at rest [m]
  std::array<float, samples_of_lamp> back{};           // -1 where it shines from its back, too, and 0 where not
  std::array<glm::vec3, samples_of_lamp> intensity{};  // area * Le that it stands for [W sr^-1]
};

struct AreaLamp {
  std::uint32_t body = 0, light = 0;  // of Scene::bodies and lights
  std::vector<LampPatch> patches = {};
  // Instead of patches. One that is a point has one sample that matters, the first.
  std::optional<scene::PunctualLight> punctual = {};
  // The patch sends as much as each of its samples does where that is, instead of one radiance everywhere.
  bool coloured = false;
  // Light of it varies little from texel to texel, so that neighbours may look at other samples each.
  bool soft = false;
  scene::Box box = {};                    // of the patches [m]
  std::vector<LampSamples> samples = {};  // one, or of a soft one as many as receivers have sets
};

// A point for each patch, in its middle, with all that it sends: what a lamp of many small ones looks like from
// afar. Those of the last that are none send nothing.
std::vector<LampSamples> middles_of(const std::vector<LampPatch>& patches);

// Puts samples on the patches behind those that there are, which `shift` sets off against others (its x in
// -0.5..0.5 of a sample's share); and finds their box.
void place_samples(AreaLamp& lamp, const glm::vec2& shift = glm::vec2(0));

// What is outside of the scene is so far away [its radii]: shadows of what is a metre apart are parallel to a
// twentieth of a degree.
constexpr float far_away = 1000;

// What hangs together of the triangles that emit, of one body and light; a triangle that is written twice
// shines once. If there are more than `most`, those that lie near each other are one, always the same ones.
// Behind them the scene's punctual lights, each a lamp, and the sky's lamps, with samples of so many sets.
std::vector<AreaLamp> find_area_lamps(const scene::Scene& scene, std::size_t most, std::uint32_t sets = 1);

}  // namespace lichtveld::lightfield
