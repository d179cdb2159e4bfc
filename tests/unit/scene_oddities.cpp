// What is odd but still makes a picture is no error, and the user hears of it.
#include <gmock/gmock.h>

#include <algorithm>

#include "scene_damage.hpp"
#include "scene_log.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;

TEST(SceneOddities, EachIsWarnedOf) {
  testing::LogCapture log;
  const std::vector<SpoiltCase> odd = {
      {"ZeroArea", [](auto& b) { overwrite(b, 2, 1, std::uint16_t{0}); },
       "1 triangles without area were dropped"},
      {"ZeroChart", [](auto& b) { overwrite(b, 1, 1, glm::vec2(0.1f, 0.9f)); },  // the first corner's
       "1 triangles have no area in TEXCOORD_1"},
      {"NoEmitter", [](auto& b) { b.gltf["materials"][0].erase("emissiveFactor"); },
       "nothing emits light; give a material an emissiveFactor"},
      {"Points",
       [](auto& b) {
         json points = b.primitive(0);
         points["mode"] = 0;
         b.gltf["meshes"][0]["primitives"].push_back(points);
       },
       "1 primitives of points or lines were left out"},
      {"BadNormals",
       [](auto& b) {
         attributes(b)["NORMAL"] = b.accessor(std::vector<glm::vec3>(4, glm::vec3(0)), 5126, "VEC3");
       },
       "1 primitives have unusable normals"},
      {"Skin",
       [](auto& b) {
         b.gltf["nodes"][0]["skin"] = 0;
         b.gltf["skins"] = {{{"joints", {2}}}};
         b.gltf["nodes"].push_back({{"name", "elsewhere"}});
       },
       "node \"floor\": has a skin whose joints are not in the scene; it is ignored"},
  };
  for (const SpoiltCase& one : odd) {
    SceneBuilder builder = sound();
    one.spoil(builder);
    EXPECT_EQ(error_of_bytes(builder.glb()), "no error") << one.name;
    const std::string lines = log.take();
    EXPECT_THAT(lines, ::testing::StartsWith("warning: ")) << one.name;
    EXPECT_THAT(lines, ::testing::HasSubstr(one.message)) << one.name;
    EXPECT_EQ(std::ranges::count(lines, '\n'), 1) << one.name << " is said once, and nothing else: " << lines;
  }
}

}  // namespace
}  // namespace lichtveld::scene
