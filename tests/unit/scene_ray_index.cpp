// What rays meet: fronts, bodies where they are, and what lies on what.
#include <gtest/gtest.h>

#include "known_scenes.hpp"
#include "lichtveld/scene/ray_index.hpp"

namespace lichtveld::scene {
namespace {

using namespace lichtveld::testing;

// A floor that looks up at y = 0, a sheet over it at y = 1 that looks down, and a movable box from y = 2 to 3.
class RayIndexTest : public ::testing::Test {
 protected:
  static Scene make(bool double_sided) {
    SceneBuilder builder;
    const int material = builder.material(glm::vec3(0.5f), glm::vec3(0), double_sided);
    square(builder, "floor", 0, false, chart_a, material);
    square(builder, "sheet", 1, true, chart_b, material);
    builder.set_movable(builder.box("box", {-0.5f, 2, -0.5f}, {0.5f, 3, 0.5f}, chart_c, material));
    return loaded(builder);
  }

  // Ray 0 of a packet, and a second one that there is not.
  static RayPacket ray(const glm::vec3& from, const glm::vec3& direction) {
    RayPacket rays{};
    for (std::uint32_t lane = 0; lane < RayPacket::size; ++lane) rays.set(lane, from, direction);
    rays.lanes = 1;
    return rays;
  }

  static HitPacket nearest(const RayIndex& index, std::uint32_t body, const glm::vec3& offset,
                           const RayPacket& rays) {
    HitPacket hits;
    hits.clear(100);
    index.nearest(body, offset, rays, hits);
    return hits;
  }
};

const glm::vec3 up(0, 1, 0), down(0, -1, 0), still(0);

TEST_F(RayIndexTest, OneSidedSurfacesAreThereFromTheirFrontAlone) {
  const auto scene = make(false);
  const RayIndex index(scene);
  const auto from_below = nearest(index, 0, still, ray({0.2f, 0.5f, 0.3f}, up));
  EXPECT_FLOAT_EQ(from_below.distance[0], 0.5f);
  EXPECT_NE(from_below.triangle[0], HitPacket::none);
  EXPECT_EQ(from_below.triangle[1], HitPacket::none) << "a lane that is none";
  const auto from_above = nearest(index, 0, still, ray({0.2f, 4, 0.3f}, down));
  EXPECT_FLOAT_EQ(from_above.distance[0], 4) << "through the sheet's back, to the floor";
  EXPECT_EQ(nearest(index, 0, still, ray({0.2f, -1, 0.3f}, down)).triangle[0], HitPacket::none);
}

TEST_F(RayIndexTest, DoubleSidedSurfacesTellTheirBack) {
  const auto scene = make(true);
  const RayIndex index(scene);
  const auto from_above = nearest(index, 0, still, ray({0.2f, 4, 0.3f}, down));
  EXPECT_FLOAT_EQ(from_above.distance[0], 3);
  EXPECT_EQ(from_above.from_behind, 1u);
  EXPECT_EQ(nearest(index, 0, still, ray({0.2f, 0.5f, 0.3f}, up)).from_behind, 0u);
}

TEST_F(RayIndexTest, BodiesAreWhereTheyAreShiftedTo) {
  const auto scene = make(false);
  const RayIndex index(scene);
  EXPECT_FLOAT_EQ(nearest(index, 1, still, ray({0.2f, 1.5f, 0.3f}, up)).distance[0], 0.5f);
  EXPECT_FLOAT_EQ(nearest(index, 1, {0, 1, 0}, ray({0.2f, 1.5f, 0.3f}, up)).distance[0], 1.5f);
  EXPECT_EQ(nearest(index, 1, {5, 0, 0}, ray({0.2f, 1.5f, 0.3f}, up)).triangle[0], HitPacket::none);
  EXPECT_EQ(nearest(index, 0, still, ray({0.2f, 1.5f, 0.3f}, up)).triangle[0], HitPacket::none)
      << "what stands still is without it";
}

TEST_F(RayIndexTest, OnlyWhatIsNearerIsTaken) {
  const auto scene = make(false);
  const RayIndex index(scene);
  HitPacket hits;
  hits.clear(0.4f);
  index.nearest(0, still, ray({0.2f, 0.5f, 0.3f}, up), hits);
  EXPECT_EQ(hits.triangle[0], HitPacket::none);
}

TEST_F(RayIndexTest, WhatIsInBetweenHides) {
  const auto scene = make(false);
  const RayIndex index(scene);
  EXPECT_EQ(index.occluded(0, still, ray({0.2f, 0.5f, 0.3f}, up), 1), 1u);
  EXPECT_EQ(index.occluded(0, still, ray({0.2f, 0.5f, 0.3f}, up), 0.4f), 0u) << "beyond its reach";
  EXPECT_EQ(index.occluded(0, still, ray({0.2f, 4, 0.3f}, down), 3.5f), 0u) << "a back";
  EXPECT_EQ(index.occluded(1, {5, 0, 0}, ray({0.2f, 1.5f, 0.3f}, up), 9), 0u);
}

TEST_F(RayIndexTest, WhatLiesOnAPlaceIsFound) {
  const auto scene = make(false);
  const RayIndex index(scene);
  // The first triangle is the floor's.
  const glm::vec3 place(0.2f, 0, 0.3f);
  EXPECT_FALSE(index.contact(0, still, place, up, 0)) << "itself";
  EXPECT_FALSE(index.contact(1, still, place, up, 0));
  EXPECT_TRUE(index.contact(1, {0, -2, 0}, place, up, 0)) << "the box stands on it";
  EXPECT_FALSE(index.contact(1, {0, -1.999f, 0}, place, up, 0)) << "a gap of 1 mm";
  EXPECT_FALSE(index.contact(1, {0, -3, 0}, place, up, 0)) << "its top looks the same way";
}

TEST_F(RayIndexTest, FarFromTheOriginNothingChanges) {
  auto scene = make(false);
  const glm::vec3 away(4096, 0, -4096);
  for (auto& vertex : scene.vertices) vertex.position += away;
  for (auto& body : scene.bodies) body.box.min += away, body.box.max += away;
  const RayIndex index(scene);
  EXPECT_FLOAT_EQ(nearest(index, 0, still, ray(away + glm::vec3(0.2f, 0.5f, 0.3f), up)).distance[0], 0.5f);
}

}  // namespace
}  // namespace lichtveld::scene
