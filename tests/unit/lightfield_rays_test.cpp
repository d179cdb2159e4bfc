// Links by rays and exact light from lamps: against known answers, the reference, and a fresh start after
// moves.
#include <gtest/gtest.h>

#include <random>

#include "core/area_lamps.hpp"
#include "core/frame.hpp"
#include "device_for_tests.hpp"
#include "form_factors.hpp"
#include "known_scenes.hpp"
#include "lichtveld/reference/error.hpp"
#include "lichtveld/reference/path_tracer.hpp"
#include "light_fields.hpp"
#include "rays/ray_sets.hpp"
#include "rays/rows.hpp"
#include "texels.hpp"

namespace lichtveld::lightfield {
namespace {

using namespace lichtveld::testing;
using scene::Offsets;

class RaysMethod : public WithDevice {
 protected:
  std::vector<glm::vec4> fresh(const scene::Scene& scene, const Settings& settings, const Offsets& offsets) {
    const auto rays = make_light_field("rays", device(), scene, settings);
    settled(*rays, offsets);
    return rays->irradiance();
  }
  std::vector<glm::vec4> fresh(const scene::Scene& scene, const Settings& settings) {
    return fresh(scene, settings, at_rest(scene));
  }
  Texels texels_of(const scene::Scene& scene, const Settings& settings) {
    return texels(scene, settings.size, fresh(scene, settings), {});
  }
};

scene::Scene cornell() {
  return scene::load(LICHTVELD_SOURCE_DIR "/assets/cornell.glb");
}

// A room of 4 m with a lamp of that size under its ceiling, a block, and two boxes that move.
scene::Scene lamp_room(float lamp) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.6f));
  builder.box("room", {-2, 0, -2}, {2, 3, 2}, {0, 0, 1, 0.5f}, grey, true);
  square(builder, "lamp", 2.9f, true, {0, 0.5f, 0.125f, 0.625f},
         builder.material(glm::vec3(0.5f), glm::vec3(8) / (lamp * lamp)), lamp / 2);
  builder.box("block", {-1.3f, 0, -1}, {-0.3f, 1, 0}, {0.125f, 0.5f, 0.5f, 0.75f}, grey);
  builder.set_movable(builder.box("a", {0.3f, 0, 0.2f}, {0.9f, 0.6f, 0.8f}, {0.5f, 0.5f, 0.875f, 0.75f},
                                  builder.material({0.8f, 0.2f, 0.2f})));
  builder.set_movable(builder.box("b", {0.4f, 1.2f, 0.3f}, {0.8f, 1.6f, 0.7f}, {0, 0.75f, 0.375f, 1}, grey));
  return loaded(builder);
}

double rel_rmse(const std::vector<glm::vec4>& irradiance, const std::vector<glm::vec4>& truth) {
  return reference::error_of(irradiance, truth).rel_rmse;
}

TEST(RaySetsTest, AreCosineDistributedAndDiffer) {
  const RaySets sets(48, 16, 0);
  ASSERT_EQ(sets.rays(), 48u);
  ASSERT_EQ(sets.sets(), 16u);
  for (std::uint32_t set = 0; set < sets.sets(); ++set) {
    glm::vec3 sum(0);
    for (const auto& direction : sets[set]) {
      EXPECT_NEAR(glm::length(direction), 1, 1e-6);
      EXPECT_GE(direction.z, 0);
      sum += direction / 48.0f;
    }
    EXPECT_NEAR(sum.z, 2.0 / 3, 0.01) << "the mean cosine";
    EXPECT_NEAR(sum.x, 0, 0.04);
    EXPECT_NEAR(sum.y, 0, 0.04);
    if (set > 0) {
      EXPECT_NE(sets[set][0], sets[0][0]);
    }
  }
  EXPECT_EQ(RaySets(48, 16, 7)[3][5], RaySets(48, 16, 7)[3][5]);
  EXPECT_NE(RaySets(48, 16, 7)[3][5], RaySets(48, 16, 8)[3][5]);
}

TEST(FrameAbout, IsRightHanded) {
  for (const auto& normal : {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::normalize(glm::vec3(1, -2, 0.5f))}) {
    const auto frame = frame_about(normal);
    EXPECT_LT(glm::distance(frame[2], normal), 1e-6f);
    EXPECT_LT(glm::distance(glm::cross(frame[0], frame[1]), normal), 1e-6f);
  }
}

// A square of side 2 at y = 2 that looks down.
constexpr LampPatch ceiling{.corner = {-1, 2, -1},
                            .u = {2, 0, 0},
                            .v = {0, 0, 2},
                            .emission = {3, 3, 3},
                            .triangle = false,
                            .double_sided = false};
const glm::vec3 up(0, 1, 0);

TEST(IrradianceOf, IsTheFormFactorToAParallelSquare) {
  for (const float x : {0.0f, 0.7f, 3.0f})
    EXPECT_NEAR(irradiance_of(ceiling, {x, 0, 0.3f}, up, up).g, pi * 3 * rectangle_factor(x, 0.3, 1, 1, 2),
                1e-5);
}

TEST(IrradianceOf, TheHalvesOfASquareSumToIt) {
  LampPatch one = ceiling, other = ceiling;
  one.triangle = other.triangle = true;
  other.corner = {1, 2, 1};
  other.u = {-2, 0, 0};
  other.v = {0, 0, -2};
  const glm::vec3 place(0.4f, 0, 0.2f);
  EXPECT_NEAR(irradiance_of(one, place, up, up).g + irradiance_of(other, place, up, up).g,
              irradiance_of(ceiling, place, up, up).g, 1e-5);
}

TEST(IrradianceOf, NothingComesFromBehindOrBelow) {
  const glm::vec3 side(1, 0, 0), down(0, -1, 0);
  EXPECT_EQ(irradiance_of(ceiling, {0, 3, 0}, down, down), glm::vec3(0)) << "its back";
  EXPECT_EQ(irradiance_of(ceiling, {0, 0, 0}, down, down), glm::vec3(0)) << "below the horizon";
  EXPECT_EQ(irradiance_of(ceiling, {0, 2, 0}, up, up), glm::vec3(0)) << "in its plane";
  // Half below the horizon: by symmetry two walls back to back receive as much as each other.
  const float right = irradiance_of(ceiling, {0, 0, 0}, side, side).g;
  EXPECT_GT(right, 0);
  EXPECT_NEAR(irradiance_of(ceiling, {0, 0, 0}, -side, -side).g, right, 1e-6);
  LampPatch both = ceiling;
  both.double_sided = true;
  EXPECT_NEAR(irradiance_of(both, {0, 4, 0}, down, down).g, irradiance_of(ceiling, {0, 0, 0}, up, up).g, 1e-5);
}

TEST_F(RaysMethod, FurnaceIsExact) {
  for (const auto direct : {Direct::exact, Direct::psf})
    for (const std::uint32_t sets : {1u, 4u, 16u}) {
      const auto irradiance =
          fresh(furnace(0.5f), {.size = 64, .psf = 96, .bounces = 3, .rays = {.sets = sets}, .direct = direct});
      for (const auto& texel : irradiance)
        if (texel.a > 0) {
          ASSERT_NEAR(texel.g / (pi * 1.75), 1, 2e-5) << sets << " sets";
        }
    }
}

TEST_F(RaysMethod, AgreesWithTheReferenceWhateverTheLampsSize) {
  for (const float lamp : {1.0f, 0.25f, 0.05f}) {
    const auto scene = lamp_room(lamp);
    const auto truth = reference::trace(scene, {}, {.size = 128, .spp = 512});
    const auto irradiance = fresh(scene, {.size = 128, .psf = 96});
    const auto error = reference::error_of(irradiance, truth.texels);
    EXPECT_LT(error.rel_rmse, 0.035) << "a lamp of " << lamp << " m; the reference has 1 to 2 % of noise";
    EXPECT_LT(std::abs(error.bias), 0.005) << "a lamp of " << lamp << " m";
  }
}

// Shadows fainter than one of a lamp's points: what most of a texel's neighbours see is not all that it sees.
TEST_F(RaysMethod, ThinBarsCastTheirShadows) {
  SceneBuilder builder;
  square(builder, "floor", 0, false, chart_a, builder.material(glm::vec3(0)));
  square(builder, "lamp", 2, true, chart_c, builder.material(glm::vec3(0), glm::vec3(9)), 0.3f);
  for (int bar = 0; bar < 4; ++bar) {
    const float x = -0.6f + 0.4f * static_cast<float>(bar), half = bar % 2 ? 0.002f : 0.01f;
    builder.set_movable(builder.box(
        "bar", {x - half, 1, -1}, {x + half, 1 + 2 * half, 1},
        {0.5f + 0.125f * static_cast<float>(bar), 0.5f, 0.6f + 0.125f * static_cast<float>(bar), 0.75f},
        builder.material(glm::vec3(0))));
  }
  const auto scene = loaded(builder);
  const Settings settings{.size = 128, .psf = 24, .bounces = 1};
  const auto traced = reference::trace(scene, {}, {.size = 128, .bounces = 1, .spp = 1024});
  const auto truth = of(texels(scene, 128, traced.texels, traced.standard_error), "floor");
  const auto seen = of(texels_of(scene, settings), "floor");
  double squares = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    squares += std::pow(seen[i].irradiance.g - truth[i].irradiance.g, 2) - std::pow(truth[i].standard_error, 2);
  EXPECT_NEAR(mean(seen) / mean(truth), 1, 0.002);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(truth.size())) / mean(truth), 0.01);
}

TEST_F(RaysMethod, MoreSetsAreNearerForTheSameRays) {
  const auto scene = lamp_room(1);
  const auto truth = fresh(scene, {.size = 64, .psf = 6144, .rays = {.sets = 1}});
  const auto error = [&](std::uint32_t sets) {
    return rel_rmse(fresh(scene, {.size = 64, .psf = 96, .rays = {.sets = sets}}), truth);
  };
  EXPECT_LT(error(4), 0.7 * error(1));
  EXPECT_LT(error(16), 0.7 * error(1));
}

// With so many bounces each time light starts afresh, and all that is kept is what the moves have changed.
TEST_F(RaysMethod, AfterAnyMovesAllIsAsIfItHadStartedThere) {
  const auto scene = lamp_room(0.25f);
  const Settings settings{.size = 64, .psf = 96, .bounces = 3};
  const auto rays = make_light_field("rays", device(), scene, settings);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> anywhere(-0.5f, 0.5f);
  for (int move = 0; move < 12; ++move) {
    auto offsets = rays->offsets();
    if (move != 5)
      offsets[1] = {anywhere(random), move == 3 ? 0.0f : 0.5f + anywhere(random), anywhere(random)};
    if (move % 2) offsets[2] = {anywhere(random), anywhere(random), anywhere(random)};
    settled(*rays, offsets);
    ASSERT_EQ(rays->irradiance(), fresh(scene, settings, offsets)) << "move " << move;
  }
  settled(*rays, at_rest(scene));
  EXPECT_EQ(rays->irradiance(), fresh(scene, settings));
}

// Wherever it is put down: the first place of a packet of rays may be one of those, or none.
TEST_F(RaysMethod, ItIsDarkUnderABody) {
  const auto scene = lamp_room(1);
  const Settings settings{.size = 256, .psf = 24, .bounces = 2};
  const auto rays = make_light_field("rays", device(), scene, settings);
  auto offsets = at_rest(scene);
  settled(*rays, offsets);
  for (const float x : {0.0f, -0.11f, -0.53f, 0.37f}) {
    offsets[1] = {x, 0, x / 2};
    settled(*rays, offsets);
    const auto box = scene.bodies[1].box;
    int under = 0, beside = 0;
    for (const auto& texel : texels(scene, settings.size, rays->irradiance(), {})) {
      const auto& place = texel.position;
      if (texel.node != "room" || place.y > 1e-4) continue;
      const auto inside = [&](double by) {
        return place.x > box.min.x + x + by && place.x < box.max.x + x - by &&
               place.z > box.min.z + x / 2 + by && place.z < box.max.z + x / 2 - by;
      };
      const double seen = texel.irradiance.g;
      if (inside(1e-3)) {
        ASSERT_EQ(seen, 0) << "at " << place.x << ", " << place.z;
        ++under;
      } else if (!inside(-1e-3) && inside(-0.1)) {
        ASSERT_GT(seen, 0) << "at " << place.x << ", " << place.z;
        ++beside;
      }
    }
    EXPECT_GT(under, 40);
    EXPECT_GT(beside, 10);
  }
}

TEST_F(RaysMethod, ALampThatMovesTakesItsLightAlong) {
  SceneBuilder builder;
  builder.box("room", {-2, 0, -2}, {2, 3, 2}, {0, 0, 1, 0.5f}, builder.material(glm::vec3(0.5f)), true);
  builder.set_movable(
      square(builder, "lamp", 2.5f, true, chart_c, builder.material(glm::vec3(0), glm::vec3(9)), 0.2f));
  builder.set_movable(
      builder.box("box", {-0.3f, 1, -0.3f}, {0.3f, 1.3f, 0.3f}, chart_d, builder.material(glm::vec3(0.5f))));
  const auto scene = loaded(builder);
  const Settings settings{.size = 64, .psf = 96, .bounces = 2};
  const auto rays = make_light_field("rays", device(), scene, settings);
  settled(*rays, at_rest(scene));
  Offsets moved = at_rest(scene);
  moved[1] = {0.7f, -0.2f, 0.4f};
  settled(*rays, moved);
  EXPECT_EQ(rays->irradiance(), fresh(scene, settings, moved));
}

TEST_F(RaysMethod, StepsFollowAndArrive) {
  const auto scene = lamp_room(0.25f);
  const Settings settings{.size = 64, .psf = 96};
  const auto rays = make_light_field("rays", device(), scene, settings);
  settled(*rays, at_rest(scene));
  Offsets moved = at_rest(scene);
  moved[1] = {-0.4f, 0.1f, 0.3f};
  EXPECT_EQ(stepped(*rays, moved).bounces, 1u);
  EXPECT_EQ(rays->light(), Light::rising);
  const auto truth = fresh(scene, settings, moved);
  EXPECT_LT(rel_rmse(rays->irradiance(), truth), 0.02) << "one bounce after the move";
  for (int i = 0; i < 60 && rays->light() != Light::settled; ++i)
    rays->step([](std::uint32_t) { return true; });
  EXPECT_EQ(rays->light(), Light::settled);
  EXPECT_LT(rel_rmse(rays->irradiance(), truth), 0.002);
}

// A double-sided sheet between a bright and a dark room, its NORMAL on the dark side.
TEST_F(RaysMethod, DoubleSidedSheetsSendFromTheSideThatIsLit) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f));
  builder.box("room", {-2, 0, -1}, {2, 2, 1}, {0, 0, 1, 0.5f}, grey, true);
  square(builder, "lamp", 1.9f, true, chart_c, builder.material(glm::vec3(0), glm::vec3(9)), 0.2f, -1);
  builder.quad("sheet", {glm::vec3(0, 0, 1), {0, 0, -1}, {0, 2, -1}, {0, 2, 1}}, chart_d,
               builder.material(glm::vec3(0.5f), glm::vec3(0), true));
  const auto scene = loaded(builder);
  const auto truth = reference::trace(scene, {}, {.size = 64, .spp = 512});
  const auto map = texels_of(scene, {.size = 64, .psf = 96});
  const auto dark = where(map, [](const Texel& texel) { return texel.position.x > 0.1; });
  const auto bright = where(map, [](const Texel& texel) { return texel.position.x < -0.1; });
  EXPECT_LT(mean(dark), 2e-3 * mean(bright)) << "but for texels that the sheet cuts through";
  std::vector<glm::vec4> irradiance = fresh(scene, {.size = 64, .psf = 96});
  EXPECT_LT(std::abs(reference::error_of(irradiance, truth.texels).bias), 0.005);
}

// Two faces that lie on each other and look away from each other are a sheet, and no body on a floor.
TEST_F(RaysMethod, ASheetOfTwoFacesIsLitOnBoth) {
  for (const bool movable : {false, true}) {
    SceneBuilder builder;
    const int grey = builder.material(glm::vec3(0.6f));
    builder.box("room", {-2, 0, -2}, {2, 3, 2}, {0, 0, 1, 0.5f}, grey, true);
    square(builder, "lamp", 2.9f, true, {0.9f, 0.9f, 1, 1}, builder.material(glm::vec3(0), glm::vec3(9)), 0.5f);
    std::vector<glm::vec3> corners;
    std::vector<glm::vec2> atlas;
    for (const float u : {0.05f, 0.4f})  // of the upper face's chart, and of the lower one's
      for (const glm::vec2 at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
        corners.emplace_back(1.4f * at.x - 0.7f, 1.2f, 1.4f * at.y - 0.7f);
        atlas.emplace_back(u + 0.25f * at.x, 0.6f + 0.25f * at.y);
      }
    const int sheet = builder.mesh("sheet", corners, atlas, {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7}, grey);
    if (movable) builder.set_movable(sheet);
    const auto scene = loaded(builder);
    const auto traced = reference::trace(scene, {}, {.size = 64, .spp = 256});
    const auto lit = of(texels_of(scene, {.size = 64, .psf = 384}), "sheet"),
               truth = of(texels(scene, 64, traced.texels, {}), "sheet");
    EXPECT_NEAR(mean(lit) / mean(truth), 1, 0.02) << (movable ? "movable" : "standing");
    for (const auto& texel : lit) ASSERT_GT(texel.irradiance.g, 0);
  }
}

// Leaves of one mesh above each other, double-sided and without TEXCOORD_1: what lies above a leaf's back is no
// body's inside.
TEST_F(RaysMethod, LeavesAboveEachOtherAreNoBody) {
  SceneBuilder builder;
  builder.box("room", {-2, 0, -2}, {2, 3, 2}, {0, 0, 1, 1}, builder.material(glm::vec3(0), glm::vec3(1)), true);
  std::vector<glm::vec3> corners;
  std::vector<std::uint16_t> indices;
  for (std::uint16_t leaf = 0; leaf < 9; ++leaf) {
    const float y = 0.8f + 0.15f * static_cast<float>(leaf), x = 0.1f * static_cast<float>(leaf % 3);
    for (const glm::vec2 at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)})
      corners.emplace_back(x + at.x - 0.6f, y + 0.05f * at.x, at.y - 0.5f);
    for (const int corner : {0, 2, 1, 0, 3, 2})
      indices.push_back(static_cast<std::uint16_t>(4 * leaf + corner));
  }
  const std::vector<glm::vec2> atlas(corners.size());
  builder.mesh("leaves", corners, atlas, indices, builder.material(glm::vec3(0.5f), glm::vec3(0), true));
  for (auto& mesh : builder.gltf["meshes"]) mesh["primitives"][0]["attributes"].erase("TEXCOORD_1");
  const auto scene = loaded(builder);
  const auto traced = reference::trace(scene, {}, {.size = 64, .spp = 64});
  const auto lit = of(texels_of(scene, {.size = 64, .psf = 96}), "leaves"),
             truth = of(texels(scene, 64, traced.texels, {}), "leaves");
  EXPECT_NEAR(mean(lit) / mean(truth), 1, 0.01);
  for (const auto* map : {&lit, &truth})
    for (const auto& texel : *map) ASSERT_GT(texel.irradiance.g, 0.2) << texel.position.y;
}

// A wall whose panels have charts that hold no texel's centre.
TEST_F(RaysMethod, ChartsWithoutATexelSendTheirLight) {
  const auto bright_mean = [&](bool small_charts) {
    SceneBuilder builder;
    const int white = builder.material(glm::vec3(0.8f)), black = builder.material(glm::vec3(0));
    square(builder, "floor", 0, false, chart_a, black);
    square(builder, "lamp", 0.1f, false, {0.6f, 0.1f, 0.65f, 0.15f},
           builder.material(glm::vec3(0), glm::vec3(100)), 0.1f, 5);
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 8; ++j) {
        const glm::vec3 low(-1 + 0.25f * static_cast<float>(i), 2, -1 + 0.25f * static_cast<float>(j));
        // 0.4 texels of 64, between their centres; or 3.
        const float u = (40.55f + static_cast<float>(i)) / 64, v = (4.55f + static_cast<float>(j)) / 64;
        const Chart chart =
            small_charts ? Chart{u, v, u + 0.4f / 64, v + 0.4f / 64}
                         : Chart{(32 + 4 * static_cast<float>(i)) / 64, (32 + 4 * static_cast<float>(j)) / 64,
                                 (35 + 4 * static_cast<float>(i)) / 64, (35 + 4 * static_cast<float>(j)) / 64};
        builder.quad(
            "panel " + std::to_string(8 * i + j),
            {low, low + glm::vec3(0.25f, 0, 0), low + glm::vec3(0.25f, 0, 0.25f), low + glm::vec3(0, 0, 0.25f)},
            chart, white);
      }
    return mean(of(texels_of(loaded(builder), {.size = 64, .psf = 384, .bounces = 2}), "floor"));
  };
  EXPECT_NEAR(bright_mean(true) / bright_mean(false), 1, 0.03);
}

TEST_F(RaysMethod, NothingThatEmitsGivesBlack) {
  for (const auto& texel : fresh(furnace(0.5f, 0), {.size = 32, .psf = 24})) EXPECT_EQ(texel.g, 0);
}

TEST_F(RaysMethod, RadianceOfAnyMagnitudeScales) {
  const auto at = [&](float emission) {
    return mean(texels_of(furnace(0.5f, emission), {.size = 32, .psf = 24, .bounces = 3})) / emission;
  };
  EXPECT_NEAR(at(1e-6f) / at(1), 1, 1e-5);
  EXPECT_NEAR(at(1e6f) / at(1), 1, 1e-5);
}

TEST_F(RaysMethod, WhatDoesNotFitIsRefusedBeforeItIsTaken) {
  const auto scene = cornell();
  const auto message = [&](const Settings& settings) -> std::string {
    try {
      make_light_field("rays", device(), scene, settings);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({.size = 64, .psf = 24}), "");
  const auto allowed = message({.size = 64, .psf = 384, .memory = 1 << 20});
  EXPECT_NE(allowed.find("1 MiB are what --memory allows; try a smaller --size"), std::string::npos) << allowed;
  const auto free = message({.size = 2048, .psf = 6144});
  EXPECT_NE(free.find("of what is free"), std::string::npos) << free;
}

TEST_F(RaysMethod, TheSameBitsOnEachRun) {
  const Settings settings{.size = 64, .psf = 96};
  EXPECT_EQ(fresh(cornell(), settings), fresh(cornell(), settings));
}

// Two halves of a lamp that are written twice shine once, and so does one of ten thousand triangles.
TEST_F(RaysMethod, ManyLampsAreSummedUp) {
  const auto floor_mean = [&](int cells) {
    SceneBuilder builder;
    square(builder, "floor", 0, false, chart_a, builder.material(glm::vec3(0)));
    const int lamp = builder.material(glm::vec3(0), glm::vec3(5));
    const float step = 2.0f / static_cast<float>(cells), side = step * 0.999f;
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j) {
        const glm::vec3 low(-1 + step * static_cast<float>(i), 2, -1 + step * static_cast<float>(j));
        builder.quad(
            "lamp",
            {low, low + glm::vec3(side, 0, 0), low + glm::vec3(side, 0, side), low + glm::vec3(0, 0, side)},
            {0.6f, 0.6f, 0.9f, 0.9f}, lamp);
      }
    return mean(of(texels_of(loaded(builder), {.size = 32, .psf = 24, .bounces = 1}), "floor"));
  };
  EXPECT_NEAR(floor_mean(12) / floor_mean(1), 1, 0.003);
}

}  // namespace
}  // namespace lichtveld::lightfield
