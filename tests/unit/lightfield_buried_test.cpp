// Texels inside of what stands there.
#include <gmock/gmock.h>

#include <algorithm>

#include "core/buried.hpp"
#include "core/texel_records.hpp"
#include "device_for_tests.hpp"
#include "known_scenes.hpp"
#include "lichtveld/reference/path_tracer.hpp"
#include "light_fields.hpp"

namespace lichtveld::lightfield {
namespace {

using namespace lichtveld::testing;

constexpr std::uint32_t size = 128;
constexpr glm::vec3 low{-2, 0, -2}, high{2, 3, 2};

// A room with a lamp, whose floor is a square, and a wall on it from that height up.
SceneBuilder walled(float foot, glm::vec3 tint = glm::vec3(0.5f)) {
  SceneBuilder builder;
  const int grey = builder.material(tint);
  builder.box("room", low, high, {0.5f, 0, 1, 0.5f}, grey, true);
  builder.box("wall", {-0.4f, foot, -1.5f}, {0.4f, 2, 1.5f}, {0, 0.5f, 0.5f, 1}, grey);
  square(builder, "lamp", 2.99f, true, {0.6f, 0.6f, 0.7f, 0.7f}, builder.material(glm::vec3(0), glm::vec3(5)),
         0.5f, 1);
  return builder;
}

bool is_in_wall(const TexelRecord& record) {
  return std::abs(record.position.x) < 0.4f && std::abs(record.position.z) < 1.5f && record.position.y < 2;
}

// Of the ceiling, behind the lamp's back.
bool is_behind_lamp(const TexelRecord& record) {
  return record.position.y > 2.99f && std::abs(record.position.x - 1) < 0.5f &&
         std::abs(record.position.z) < 0.5f;
}

TEST(BuriedTexels, AreThoseInAWallThroughTheFloorAndOfItBelow) {
  const auto scene = loaded(walled(-0.4f));
  const TexelRecords records(scene, size);
  const scene::RayIndex index(scene);
  const auto buried = find_buried(index, scene, records.all());
  std::size_t in_wall = 0, below = 0, behind = 0;
  for (std::uint32_t i = 0; i < records.count(); ++i) {
    const bool inside = scene.surfaces[records[i].surface].node == "room" && is_in_wall(records[i]);
    const bool under = scene.surfaces[records[i].surface].node == "wall" && records[i].position.y < 0 &&
                       records[i].face.y > -0.5f;
    const bool over = scene.surfaces[records[i].surface].node == "room" && is_behind_lamp(records[i]);
    in_wall += inside;
    below += under;
    behind += over;
    ASSERT_EQ(buried[i] != 0, inside || under || over)
        << scene.surfaces[records[i].surface].node << " " << records[i].position.x << " "
        << records[i].position.y << " " << records[i].position.z;
  }
  EXPECT_GT(in_wall, 10u);
  EXPECT_GT(below, 10u);
  EXPECT_EQ(BuriedTexels(scene, size).count(), in_wall + below + behind);
}

// A floor that is a body itself, of which the wall's foot ends inside.
TEST(BuriedTexels, AreThoseInASlab) {
  auto builder = walled(0.1f);
  builder.box("slab", {-1.9f, 0.02f, -1.9f}, {1.9f, 0.3f, 1.9f}, {0, 0, 0.5f, 0.5f}, 0);
  const auto scene = loaded(builder);
  const TexelRecords records(scene, size);
  const auto buried = find_buried(scene::RayIndex(scene), scene, records.all());
  for (std::uint32_t i = 0; i < records.count(); ++i) {
    const auto& node = scene.surfaces[records[i].surface].node;
    const auto& at = records[i].position;
    if (node == "slab" && at.y > 0.29f) {
      EXPECT_EQ(buried[i] != 0, is_in_wall(records[i])) << at.x << " " << at.z;
    }
    if (node == "wall") {
      EXPECT_EQ(buried[i] != 0, at.y < 0.3f) << at.y;
    }
  }
}

// What something stands on gets no light, and says so.
TEST(BuriedTexels, AreNotThoseThatSomethingStandsOn) {
  const auto scene = loaded(walled(0));
  const TexelRecords records(scene, size);
  const auto behind_lamp = std::ranges::count_if(
      records.all(), [&](const auto& r) { return r.face.y < 0 && is_behind_lamp(r) && r.position.y > 2.995f; });
  EXPECT_EQ(BuriedTexels(scene, size).count(), behind_lamp);
}

// Beside a room that is open to look into from behind its walls there is ground in the sun.
TEST(BuriedTexels, AreNoneOfTheGroundOutside) {
  auto builder = walled(0);
  square(builder, "ground", -0.01f, false, {0, 0, 0.5f, 0.5f}, 0, 8);
  auto scene = loaded(builder);
  scene.sky.emplace().radiance = {glm::vec3(1)};
  const TexelRecords records(scene, size);
  const auto buried = find_buried(scene::RayIndex(scene), scene, records.all());
  std::size_t ground = 0;
  for (std::uint32_t i = 0; i < records.count(); ++i) {
    const auto& at = records[i].position;
    if (scene.surfaces[records[i].surface].node != "ground" || std::max(std::abs(at.x), std::abs(at.z)) < 2)
      continue;
    ++ground;
    ASSERT_FALSE(buried[i]) << at.x << " " << at.z;
  }
  EXPECT_GT(ground, 1000u);
}

class Buried : public WithDevice {};

// Along the wall's foot there is no line: what is shown goes on as beside it.
TEST_F(Buried, TakeTheLightOfTheirVisibleNeighbours) {
  const auto scene = loaded(walled(-0.4f));
  const TexelRecords records(scene, size);
  const auto hidden = find_buried(scene::RayIndex(scene), scene, records.all());
  std::vector<std::uint32_t> number(std::size_t{size} * size, no_record);
  for (std::uint32_t i = 0; i < records.count(); ++i) number[records[i].atlas] = i;
  for (const std::string method : {"rays", "reference"}) {
    std::vector<glm::vec4> irradiance;
    if (method == "rays") {
      const auto light = engine(method).make(device(), scene, {.size = size, .psf = 384});
      light->settle();
      irradiance = light->irradiance();
    } else {
      irradiance = reference::trace(scene, at_rest(scene), {.size = size, .bounces = {}, .spp = 256}).texels;
    }
    const auto before = irradiance;
    BuriedTexels(scene, size).take_light_of_neighbours(irradiance);
    std::size_t looked_at = 0;
    double was = 0, is = 0, beside = 0;
    for (std::uint32_t i = 0; i < records.count(); ++i) {
      const auto atlas = records[i].atlas;
      if (!hidden[i]) {
        ASSERT_EQ(before[atlas], irradiance[atlas]) << "visible ones are as they were";
        continue;
      }
      for (const std::uint32_t other : {atlas - 1, atlas + 1}) {
        if (number[other] == no_record || hidden[number[other]]) continue;
        if (records[number[other]].surface != records[i].surface ||
            glm::dot(records[number[other]].normal, records[i].normal) < 0.9f)
          continue;
        ++looked_at;
        was += std::abs(before[atlas].g - irradiance[other].g);
        is += std::abs(irradiance[atlas].g - irradiance[other].g);
        beside += irradiance[other].g;
      }
    }
    EXPECT_GT(looked_at, 10u);
    EXPECT_GT(was / beside, 0.2) << method << ": the scene has no such line";
    EXPECT_LT(is, was / 2) << method;
    std::printf("%s: %zu buried texels are %.3f off those beside, of %.3f; lit they are %.3f\n", method.c_str(),
                looked_at, is, beside, was);
  }
}

}  // namespace
}  // namespace lichtveld::lightfield
