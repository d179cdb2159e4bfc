// The shipped room: closed, named, well charted, and what its script writes.
#include <gmock/gmock.h>

#include <cstdlib>
#include <set>
#include <sstream>

#include "lichtveld/scene/atlas.hpp"
#include "lichtveld/scene/motion.hpp"
#include "lichtveld/scene/scene.hpp"
#include "scene_builder.hpp"

namespace lichtveld::scene {
namespace {

constexpr const char* cornell_file = LICHTVELD_SOURCE_DIR "/assets/cornell.glb";

class SceneCornell : public ::testing::Test {
 protected:
  glm::dvec3 area_vector(const Surface& surface, std::uint32_t t) const {
    const auto p = [&](std::uint32_t k) {
      return glm::dvec3(scene_.vertices[scene_.indices[surface.first_index + t + k]].position);
    };
    return glm::cross(p(1) - p(0), p(2) - p(0)) / 2.0;
  }

  // Integral of the normal over the surfaces that `wanted` takes, their area, and the volume they enclose
  // (negative if they face inwards).
  struct Integral {
    glm::dvec3 normal{0};
    double area = 0, volume = 0;
  };
  template <typename Wanted>
  Integral integrate(Wanted wanted) const {
    Integral sum;
    for (const Surface& surface : scene_.surfaces) {
      if (!wanted(surface.node)) continue;
      for (std::uint32_t t = 0; t < surface.index_count; t += 3) {
        const glm::dvec3 a = area_vector(surface, t);
        sum.normal += a;
        sum.area += glm::length(a);
        sum.volume +=
            glm::dot(a, glm::dvec3(scene_.vertices[scene_.indices[surface.first_index + t]].position)) / 3;
      }
    }
    return sum;
  }

  Scene scene_ = load(cornell_file);
};

TEST_F(SceneCornell, HasTheTenNodesAndTwoCubes) {
  std::set<std::string> names;
  for (const Surface& surface : scene_.surfaces) names.insert(surface.node);
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("floor", "ceiling", "back", "left", "right", "front",
                                                     "short_block", "tall_block", "cube1", "cube2"));
  EXPECT_EQ(scene_.surfaces.size(), 10u);
  EXPECT_EQ(find_body(scene_, "cube1"), 1u);
  EXPECT_EQ(find_body(scene_, "cube2"), 2u);
  const Box& cube = scene_.bodies[1].box;
  EXPECT_LT(glm::distance((cube.min + cube.max) / 2.0f, scene_.bodies[1].place), 1e-5f);
}

TEST_F(SceneCornell, RedIsLeftGreenIsRightAndTheCeilingShines) {
  for (const Surface& surface : scene_.surfaces) {
    const Material& material = scene_.materials[surface.material];
    const glm::vec3 at = scene_.vertices[scene_.indices[surface.first_index]].position;
    if (surface.node == "left") {
      EXPECT_TRUE(at.x < 0 && material.base_colour.r > 2 * material.base_colour.g);
    }
    if (surface.node == "right") {
      EXPECT_TRUE(at.x > 0 && material.base_colour.g > 2 * material.base_colour.r);
    }
    EXPECT_EQ(material.emission, glm::vec3(surface.node == "ceiling" ? 10 : 0)) << surface.node;
    EXPECT_FALSE(material.double_sided);
  }
}

TEST_F(SceneCornell, RoomBlocksAndCubesAreClosed) {
  const auto room =
      integrate([](const std::string& node) { return !node.ends_with("block") && !node.starts_with("cube"); });
  EXPECT_LT(glm::length(room.normal), 1e-4);
  EXPECT_NEAR(room.volume, -5.54 * 5.488 * 5.592, 0.2);
  EXPECT_NEAR(room.area, 2 * (5.54 * 5.488 + 5.54 * 5.592 + 5.488 * 5.592), 0.3);
  for (const auto& [name, volume] : {std::pair{"short_block", 1.65 * 1.65 * 1.65},
                                     {"tall_block", 1.65 * 1.65 * 3.3},
                                     {"cube1", 0.55 * 0.55 * 0.55},
                                     {"cube2", 0.55 * 0.55 * 0.55}}) {
    const auto body = integrate([name = name](const std::string& node) { return node == name; });
    EXPECT_LT(glm::length(body.normal), 1e-5) << name;
    EXPECT_NEAR(body.volume, volume, 0.03 * volume) << name;
  }
}

TEST_F(SceneCornell, CubesMoveFreelyInXAndY) {
  const float step = step_length(scene_);
  for (std::uint32_t cube : {1u, 2u}) {
    for (const glm::vec3 way :
         {glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, -1, 0)}) {
      const glm::vec3 wanted = way * (3 * step);
      EXPECT_EQ(free_step(scene_, std::vector<glm::vec3>(3), cube, wanted), wanted)
          << cube << " " << way.x << " " << way.y;
    }
  }
}

TEST_F(SceneCornell, ChartsAlignToTexels) {
  std::uint32_t cells = check_atlas(scene_, 64);
  EXPECT_EQ(check_atlas(scene_, 128), 4 * cells);
  EXPECT_EQ(check_atlas(scene_, 256), 16 * cells);
  EXPECT_GT(cells, 64u * 64u * 3 / 4) << "most of the atlas is used";
}

// Charts are found as connected triangles; between the texels of two of them lie at least 2 + 2 others at 256.
TEST_F(SceneCornell, GuttersAreTwoTexelsOnEverySide) {
  constexpr int side = 256;
  std::vector<int> chart_at(side * side, -1);
  std::vector<glm::ivec4>
      charts;  // left, top, right, bottom: every chart is a rectangle, made of two triangles
  for (std::size_t first = 0; first < scene_.indices.size(); first += 6) {
    glm::vec2 low(1), high(0);
    for (std::size_t k = 0; k < 6; ++k) {
      const glm::vec2 uv = scene_.vertices[scene_.indices[first + k]].atlas;
      low = glm::min(low, uv);
      high = glm::max(high, uv);
    }
    charts.emplace_back(glm::ivec2(low * 256.0f), glm::ivec2(high * 256.0f));
  }
  EXPECT_EQ(charts.size(), 6u + 6 + 6 + 6 + 6);
  for (std::size_t c = 0; c < charts.size(); ++c) {
    const glm::ivec4 grown = charts[c] + glm::ivec4(-2, -2, 2, 2);
    ASSERT_TRUE(grown.x >= 0 && grown.y >= 0 && grown.z <= side && grown.w <= side) << "chart " << c;
    for (int y = grown.y; y < grown.w; ++y) {
      for (int x = grown.x; x < grown.z; ++x) {
        ASSERT_EQ(chart_at[static_cast<std::size_t>(y * side + x)], -1)
            << "chart " << c << " at " << x << ", " << y;
        chart_at[static_cast<std::size_t>(y * side + x)] = static_cast<int>(c);
      }
    }
  }
}

TEST_F(SceneCornell, TheScriptWritesTheCommittedFile) {
  const testing::TempFolder folder;
  const std::string out = (folder.path() / "again.glb").string();
  ASSERT_EQ(std::system(("python3 " LICHTVELD_SOURCE_DIR "/assets/make_cornell.py " + out).c_str()), 0);
  const auto bytes = [](const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_TRUE(bytes(out) == bytes(cornell_file)) << "run assets/make_cornell.py and commit cornell.glb";
}

}  // namespace
}  // namespace lichtveld::scene
