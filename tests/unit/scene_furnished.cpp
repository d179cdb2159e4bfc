// The furnished room of assets/: what its script writes, and what there is in it.
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

#include "lichtveld/scene/atlas.hpp"
#include "lichtveld/scene/lights.hpp"
#include "lichtveld/scene/scene.hpp"
#include "scene_builder.hpp"
#include "scene_log.hpp"

namespace lichtveld::scene {
namespace {

using namespace lichtveld::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string file = LICHTVELD_SOURCE_DIR "/assets/room.glb";

std::string bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(FurnishedRoom, IsWhatItsScriptWrites) {
  const TempFolder folder;
  const std::string out = (folder.path() / "room.glb").string(),
                    script = "python3 -B " LICHTVELD_SOURCE_DIR "/assets/make_room.py ";
  ASSERT_EQ(std::system((script + out + " 2>/dev/null").c_str()), 0);
  EXPECT_TRUE(bytes(out) == bytes(file)) << "run assets/make_room.py and commit room.glb";
  ASSERT_EQ(std::system((script + "--flicker " + out + " 2>/dev/null").c_str()), 0);
  const auto lamp = load(out).lights.at(3);
  EXPECT_EQ(lamp.node, "table lamp");
  EXPECT_GT(lamp.flicker, 0);
}

TEST(FurnishedRoom, HasItsLightsAndCubes) {
  LogCapture log;
  const auto scene = load(file);
  EXPECT_THAT(log.take(), Not(HasSubstr("warning")));
  std::vector<std::string> lights, bodies;
  for (const auto& light : scene.lights) lights.push_back(light.node);
  for (const auto& body : scene.bodies) bodies.push_back(body.node);
  EXPECT_THAT(lights, ElementsAre("what does not switch", "pendant", "floor lamp", "table lamp", "sun", "sky"));
  EXPECT_THAT(bodies, ElementsAre("standing scene", "cube1", "cube2"));
  EXPECT_EQ(scene.lights[3].body, 1u) << "the table lamp is carried";
  ASSERT_TRUE(scene.sky);
  EXPECT_EQ(scene.punctual.size(), 1u);
  const auto triangles = scene.indices.size() / 3;
  EXPECT_GE(triangles, 10'000u);
  EXPECT_LE(triangles, 30'000u);
  for (const std::uint32_t size : {128u, 256u, 512u}) EXPECT_GT(check_atlas(scene, size), size * size / 3);
}

}  // namespace
}  // namespace lichtveld::scene
