// Scenes whose answers are known: a furnace, squares that face each other, and where their charts lie.
#pragma once

#include <numbers>

#include "lichtveld/scene/scene.hpp"
#include "scene_builder.hpp"

namespace lichtveld::testing {

constexpr double pi = std::numbers::pi;

inline scene::Scene loaded(const SceneBuilder& builder) {
  const TempFolder folder;
  return scene::load(folder.write("scene.glb", builder.glb()));
}

// A closed box [-1, 1]^3 whose walls all emit `emission` and reflect `albedo`.
inline scene::Scene furnace(float albedo, float emission = 1) {
  SceneBuilder builder;
  builder.box("room", glm::vec3(-1), glm::vec3(1), {0, 0, 1, 1},
              builder.material(glm::vec3(albedo), glm::vec3(emission)), true);
  return loaded(builder);
}

// A horizontal square of side 2 * `half` about (x, y, 0).
inline int square(SceneBuilder& builder, const char* name, float y, bool down, Chart chart, int material,
                  float half = 1, float x = 0) {
  const float l = x - half, r = x + half, h = half;
  if (down) return builder.quad(name, {glm::vec3(l, y, -h), {r, y, -h}, {r, y, h}, {l, y, h}}, chart, material);
  return builder.quad(name, {glm::vec3(l, y, h), {r, y, h}, {r, y, -h}, {l, y, -h}}, chart, material);
}

// Charts whose edges lie between texels at sizes that 16 divides: the mean over texels is the midpoint rule.
constexpr Chart chart_a{1.f / 16, 1.f / 16, 7.f / 16, 7.f / 16},
    chart_b{9.f / 16, 1.f / 16, 15.f / 16, 7.f / 16}, chart_c{1.f / 16, 9.f / 16, 7.f / 16, 15.f / 16},
    chart_d{9.f / 16, 9.f / 16, 15.f / 16, 15.f / 16};
constexpr Chart whole_atlas{0, 0, 1, 1};

// The black faces of a room |x|, |z| <= 1, 0 <= y <= height as seen from inside, except its floor and one that
// the scene has instead. Their charts lie between the quadrants that chart_a to chart_d stand in.
inline void black_room(SceneBuilder& builder, const std::string& except = "", float height = 2) {
  const int black = builder.material(glm::vec3(0));
  const float h = height;
  const struct {
    const char* name;
    std::array<glm::vec3, 4> corners;
  } faces[] = {{"ceiling", {glm::vec3(-1, h, -1), {1, h, -1}, {1, h, 1}, {-1, h, 1}}},
               {"left", {glm::vec3(-1, 0, 1), {-1, 0, -1}, {-1, h, -1}, {-1, h, 1}}},
               {"right", {glm::vec3(1, 0, -1), {1, 0, 1}, {1, h, 1}, {1, h, -1}}},
               {"back", {glm::vec3(-1, 0, -1), {1, 0, -1}, {1, h, -1}, {-1, h, -1}}},
               {"front", {glm::vec3(1, 0, 1), {-1, 0, 1}, {-1, h, 1}, {1, h, 1}}}};
  float v = 1.f / 16;
  for (const auto& face : faces) {
    if (face.name != except)
      builder.quad(face.name, face.corners, {15.f / 32, v, 17.f / 32, v + 2.f / 16}, black);
    v += 3.f / 16;
  }
}

}  // namespace lichtveld::testing
