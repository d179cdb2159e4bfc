// What filtering reads beside charts.
#include <gmock/gmock.h>

#include "known_scenes.hpp"
#include "lichtveld/scene/gutters.hpp"
#include "shapes.hpp"

namespace lichtveld::scene {
namespace {

using namespace lichtveld::testing;

constexpr std::uint32_t size = 128;

struct Metres {
  double apart = 0;  // of a place and the texels that are read there
  std::size_t none = 0, reads = 0;
};

// Looks up places all over the charts, as a browser does.
Metres looked_up(const Scene& scene) {
  const auto valid = valid_texels(scene, size);
  const auto source = gutter_sources(scene, size, valid);
  std::vector<glm::vec3> position(source.size());
  const auto place = [&](const SurfacePoint& at) {
    const glm::vec3 w = weights(at);
    glm::vec3 there(0);
    for (std::size_t k = 0; k < 3; ++k)
      there += w[static_cast<int>(k)] * scene.vertices[scene.indices[3 * at.triangle + k]].position;
    return there;
  };
  for (const auto& texel : valid) position[texel.index] = place(texel.at);
  Metres metres;
  for (std::uint32_t triangle = 0; triangle < scene.indices.size() / 3; ++triangle)
    for (const glm::vec2 at :
         {glm::vec2(0.01f), {0.98f, 0.01f}, {0.01f, 0.98f}, {0.5f, 0}, {0, 0.5f}, {0.5f, 0.5f}}) {
      const SurfacePoint point{triangle, at};
      const glm::vec3 w = weights(point);
      glm::vec2 centre(-0.5f);
      for (std::size_t k = 0; k < 3; ++k)
        centre += w[static_cast<int>(k)] * scene.vertices[scene.indices[3 * triangle + k]].atlas *
                  static_cast<float>(size);
      const glm::vec2 low = glm::floor(centre), share = centre - low;
      for (const glm::vec2 corner : {glm::vec2(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
        const glm::vec2 weight = glm::mix(1.0f - share, share, corner), texel = low + corner;
        if (weight.x * weight.y < 0.05f) continue;
        const auto from =
            source.at(static_cast<std::size_t>(texel.y) * size + static_cast<std::size_t>(texel.x));
        ++metres.reads;
        if (from == no_texel)
          ++metres.none;
        else
          metres.apart = std::max<double>(metres.apart, glm::distance(position[from], place(point)));
      }
    }
  return metres;
}

SceneBuilder ball(bool own_atlas) {
  SceneBuilder builder;
  sphere(builder, "ball", 1, 12, false, whole_atlas, builder.material(glm::vec3(0.5f), glm::vec3(1)));
  if (!own_atlas) builder.primitive(0)["attributes"].erase("TEXCOORD_1");
  return builder;
}

Scene unwrapped(const SceneBuilder& builder) {
  const TempFolder folder;
  return load(folder.write("scene.glb", builder.glb()), {.unwrap = {.size = size}});
}

// Charts with corners and steps, two texels apart.
TEST(Gutters, OfUnwrappedChartsHaveTheLightOfThePlace) {
  const auto metres = looked_up(unwrapped(ball(false)));
  EXPECT_GT(metres.reads, 4000u);
  EXPECT_EQ(metres.none, 0u);
  EXPECT_LT(metres.apart, 0.25) << "where a texel is 4 cm wide";
}

TEST(Gutters, OfSquareChartsAreTheNextTexels) {
  const auto metres = looked_up(unwrapped(ball(true)));
  EXPECT_EQ(metres.none, 0u);
  EXPECT_LT(metres.apart, 0.15);
}

// The tip of one chart ends where another lies: it has no texel there, and the other's is nearer.
TEST(Gutters, AtATipAreNotANeighbours) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f), glm::vec3(1));
  const auto texels = [](float u, float v) { return glm::vec2(u, v) / static_cast<float>(size); };
  builder.mesh("tip", {{0, 0, 0}, {0, 0, 0.1f}, {1, 0, 0.05f}},
               {texels(20, 20), texels(20, 24), texels(41.3f, 22.3f)}, {}, grey);
  builder.mesh("other", {{0, 1, 0}, {0, 1, 1}, {1, 1, 0}}, {texels(42, 20), texels(42, 30), texels(52, 20)}, {},
               grey);
  const auto scene = unwrapped(builder);
  ASSERT_TRUE(scene.unwrapped.empty());
  const auto source = gutter_sources(scene, size, valid_texels(scene, size));
  const auto from = source[22 * size + 41];
  ASSERT_NE(from, no_texel);
  EXPECT_LT(from % size, 42u) << "the texel is beside both, and the tip is nearer";
}

}  // namespace
}  // namespace lichtveld::scene
