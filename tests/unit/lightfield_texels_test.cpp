// Texel records against what geometry_texture draws, and what engines take from them.
#include <gmock/gmock.h>

#include <cstdio>

#include "core/texel_records.hpp"
#include "device_for_tests.hpp"
#include "known_scenes.hpp"
#include "lichtveld/scene/atlas.hpp"
#include "lichtveld/scene/gutters.hpp"
#include "light_fields.hpp"
#include "passes/geometry_texture.hpp"
#include "shapes.hpp"

namespace lichtveld::lightfield {
namespace {

using namespace lichtveld::testing;

// Charts with edges through texels' centres, along them, at a slant, and smaller than a texel.
scene::Scene awkward_charts() {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f)),
            lamp = builder.material(glm::vec3(0.2f), glm::vec3(3, 2, 1));
  square(builder, "through centres", 0, false, {1.5f / 64, 1.5f / 64, 20.5f / 64, 20.5f / 64}, grey);
  square(builder, "along texels", 1, true, {22.f / 64, 2.f / 64, 40.f / 64, 20.f / 64}, lamp);
  square(builder, "anywhere", 2, false, {41.123f / 64, 2.71f / 64, 60.91f / 64, 17.37f / 64}, grey);
  square(builder, "small", 3, false, {61.6f / 64, 30.6f / 64, 61.9f / 64, 30.9f / 64}, grey);
  sliver_square(builder, "slivers", 4, false, {2.2f / 64, 24.3f / 64, 24.7f / 64, 44.1f / 64}, grey, 37);
  disc(builder, "disc", {0, 5, 0}, 1, {30.f / 64, 24.f / 64, 58.f / 64, 52.f / 64}, lamp);
  return loaded(builder);
}

scene::Scene round_room() {
  SceneBuilder builder;
  sphere(builder, "sphere", 2, 14, true, whole_atlas, builder.material({0.1f, 0.5f, 0.9f}),
         builder.material(glm::vec3(0.3f), glm::vec3(10)));
  return loaded(builder);
}

struct Named {
  std::string name;
  scene::Scene (*scene)();
};
void PrintTo(const Named& named, std::ostream* out) {
  *out << named.name;
}

scene::Scene cornell() {
  return scene::load(LICHTVELD_SOURCE_DIR "/assets/cornell.glb");
}

class Records : public WithDevice, public ::testing::WithParamInterface<Named> {
 protected:
  struct Drawn {
    std::vector<glm::vec4> position, normal, face, albedo;
  };
  // What the pass draws with the bodies there.
  Drawn drawn(const scene::Scene& scene, const TexelRecords& records, const scene::Offsets& offsets) {
    Geometry geometry(device(), scene);
    const LightMap map(device(), records);
    geometry.place(offsets);
    const GeometryTexture geometry_texture(device());
    gpu::Frame frame(device());
    geometry_texture.record(frame, geometry, map, {});
    frame.submit_and_wait();
    const auto values = [&](const gpu::Image& image) { return gpu::download<glm::vec4>(device(), image); };
    return {values(map.position), values(map.normal), values(map.face_normal), values(map.albedo)};
  }
};

// One definition of a valid texel: the CPU's, by which scenes are checked, traced and numbered, is what the
// device draws, texel by texel; and each is the same place there.
TEST_P(Records, AreWhatTheDeviceDraws) {
  const auto scene = GetParam().scene();
  auto offsets = at_rest(scene);
  for (std::size_t body = 1; body < offsets.size(); ++body) offsets[body] = {0.3f, -0.2f, 0.1f};
  for (const std::uint32_t size : {16u, 64u, 100u, 256u}) {
    const TexelRecords records(scene, size);
    const auto on_device = drawn(scene, records, offsets);
    std::vector<bool> valid(std::size_t{size} * size);
    double farthest = 0;
    for (const auto& record : records.all()) {
      ASSERT_LT(record.atlas, valid.size());
      ASSERT_FALSE(valid[record.atlas]) << "numbered twice";
      valid[record.atlas] = true;
      const auto at = glm::vec3(on_device.position[record.atlas]) - offsets[record.body];
      farthest = std::max<double>(farthest, glm::distance(at, record.position) / record.side);
      EXPECT_LT(glm::distance(glm::vec3(on_device.normal[record.atlas]), record.normal), 2e-2);
      EXPECT_EQ(on_device.face[record.atlas].a, static_cast<float>(record.triangle)) << record.atlas;
      EXPECT_LT(glm::distance(glm::vec3(on_device.face[record.atlas]), record.face), 1e-2);
      EXPECT_EQ(glm::vec3(on_device.albedo[record.atlas]), record.albedo);
    }
    std::size_t differing = 0;
    for (std::size_t texel = 0; texel < valid.size(); ++texel)
      differing += valid[texel] != (on_device.position[texel].a > 0);
    EXPECT_EQ(differing, 0u) << "texels are valid here and not there, at size " << size;
    EXPECT_EQ(records.count(), scene::check_atlas(scene, size));
    std::printf("%-10s size %4u: %6u texels, at most %.5f texels apart\n", GetParam().name.c_str(), size,
                records.count(), farthest);
    EXPECT_LT(farthest, 1.0 / 128) << "corners are snapped to 1/256 texel";
  }
}

// By brute force: of the texels on charts within the gutter's width the nearest.
TEST_P(Records, GuttersNameTheirNearest) {
  constexpr std::uint32_t size = 64;
  const auto scene = GetParam().scene();
  const TexelRecords records(scene, size);
  const auto belongs = scene::gutter_sources(scene, size, scene::valid_texels(scene, size));
  ASSERT_EQ(records.source().size(), size * size);
  const auto distance_to = [&](std::uint32_t texel, const TexelRecord& record) {
    const glm::ivec2 apart =
        glm::abs(glm::ivec2(texel % size, texel / size) - glm::ivec2(record.atlas % size, record.atlas / size));
    return std::max(apart.x, apart.y) > 2 ? 1000 : apart.x * apart.x + apart.y * apart.y;
  };
  for (std::uint32_t texel = 0; texel < size * size; ++texel) {
    int nearest = 1000;
    for (const auto& record : records.all()) nearest = std::min(nearest, distance_to(texel, record));
    const auto source = records.source()[texel];
    ASSERT_EQ(source == no_record, nearest == 1000 && belongs[texel] == scene::no_texel) << texel;
    if (belongs[texel] != scene::no_texel) {
      ASSERT_EQ(records[source].atlas, belongs[texel]) << "what a chart reads there";
    } else if (source != no_record) {
      ASSERT_EQ(distance_to(texel, records[source]), nearest) << texel;
    }
  }
}

// Lamps first, and among either kind neighbours in number are neighbours in the atlas.
TEST_P(Records, LampsComeFirst) {
  const TexelRecords records(GetParam().scene(), 64);
  const auto& lamps = records.lamps();
  for (std::uint32_t number = 0; number < records.count(); ++number) {
    const bool lamp = Lamps::is_lamp(records[number].emission, lamps.brightest());
    ASSERT_EQ(lamp, number < lamps.count());
    if (lamp) {
      ASSERT_EQ(lamps.emission()[number], records[number].emission);
    }
  }
  for (std::uint32_t number = 0; number < lamps.alike(); ++number)
    ASSERT_EQ(lamps.emission()[number], lamps.emission().front());
}

INSTANTIATE_TEST_SUITE_P(Scenes, Records,
                         ::testing::Values(Named{"cornell", cornell}, Named{"awkward", awkward_charts},
                                           Named{"round", round_room}),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace lichtveld::lightfield
