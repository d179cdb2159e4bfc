// Kept links against known answers, against the thesis' method, and moved bodies against a fresh start.
#include <gmock/gmock.h>

#include <random>

#include "device_for_tests.hpp"
#include "known_scenes.hpp"
#include "lichtveld/reference/error.hpp"
#include "light_fields.hpp"

namespace lichtveld::lightfield {
namespace {

using namespace lichtveld::testing;
using scene::Offsets;

class LinksMethod : public WithDevice {
 protected:
  std::vector<glm::vec4> fresh(const scene::Scene& scene, const Settings& settings, const Offsets& offsets) {
    const auto links = make_light_field("links", device(), scene, settings);
    settled(*links, offsets);
    return links->irradiance();
  }
  std::vector<glm::vec4> fresh(const scene::Scene& scene, const Settings& settings) {
    return fresh(scene, settings, at_rest(scene));
  }
};

scene::Scene cornell() {
  return scene::load(LICHTVELD_SOURCE_DIR "/assets/cornell.glb");
}

double rel_rmse(const std::vector<glm::vec4>& irradiance, const std::vector<glm::vec4>& truth) {
  return reference::error_of(irradiance, truth).rel_rmse;
}

// Bounces that nobody waits for read radiance in full.
TEST_F(LinksMethod, FurnaceIsExact) {
  const auto irradiance = fresh(furnace(0.5f), {.size = 64, .psf = 96, .bounces = 3});
  for (const auto& texel : irradiance)
    if (texel.a > 0) {
      ASSERT_NEAR(texel.g / (pi * 1.75), 1, 1e-5);
    }
}

TEST_F(LinksMethod, FurnaceConvergesByItself) {
  const auto scene = furnace(0.8f);
  const auto links = make_light_field("links", device(), scene, {.size = 32, .psf = 96});
  const auto solution = settled(*links, at_rest(scene));
  EXPECT_LT(solution.residual, 1e-3);
  EXPECT_EQ(links->light(), Light::settled);
  EXPECT_EQ(solution.misses, 0u);
  for (const auto& texel : links->irradiance())
    if (texel.a > 0) {
      ASSERT_NEAR(texel.g / (pi / (1 - 0.8)), 1, 1e-3);  // the bound
    }
}

// They differ by where the pixels lie, since a pair shares one raster and the thesis has one for either
// direction, and by the nearest texel instead of a blend of four: little where pixels are small.
TEST_F(LinksMethod, AgreesWithTheThesis) {
  const auto scene = cornell();
  for (const std::optional<std::uint32_t> bounces : {std::optional(1u), std::optional(3u)}) {
    const Settings settings{.size = 128,
                            .psf = 96,
                            .psf_size = 512,
                            .bounces = bounces,
                            .thesis = {.abuffer = ABuffer::list, .sort = Sort::scan},
                            .direct = Direct::psf};
    const auto thesis = make_light_field("thesis", device(), scene, settings);
    settled(*thesis, at_rest(scene));
    EXPECT_LT(rel_rmse(fresh(scene, settings), thesis->irradiance()), 0.03);
  }
}

TEST_F(LinksMethod, LinksOf32BitsSayTheSame) {
  SceneBuilder builder;  // at 512 texels a side more than 16 bits can number
  builder.box("room", glm::vec3(-1), glm::vec3(1), {0, 0, 1, 1},
              builder.material(glm::vec3(0.5f), glm::vec3(1)), true);
  const auto irradiance = fresh(loaded(builder), {.size = 512, .psf = 8, .bounces = 2});
  std::size_t valid = 0;
  for (const auto& texel : irradiance)
    if (texel.a > 0) {
      ASSERT_NEAR(texel.g / (pi * 1.5), 1, 2e-3);
      ++valid;
    }
  EXPECT_GT(valid, 65535u);
}

// Two sealed rooms: what the bright one's light is summed in must not cost the dim one its own.
TEST_F(LinksMethod, DimLightIsRightBesideBright) {
  for (const float dim : {1e-2f, 1e-3f, 1e-6f}) {
    SceneBuilder builder;
    const glm::vec3 aside(4, 0, 0);
    builder.box("bright room", glm::vec3(-1), glm::vec3(1), {0, 0, 0.5, 1},
                builder.material(glm::vec3(0.5f), glm::vec3(1)), true);
    builder.box("dim room", aside - 1.0f, aside + 1.0f, {0.5, 0, 1, 1},
                builder.material(glm::vec3(0.5f), glm::vec3(dim)), true);
    const auto irradiance = fresh(loaded(builder), {.size = 64, .psf = 96, .bounces = 3});
    for (std::size_t texel = 0; texel < irradiance.size(); ++texel)
      if (irradiance[texel].a > 0) {
        ASSERT_NEAR(irradiance[texel].g / (pi * 1.75 * (texel % 64 < 32 ? 1 : dim)), 1, 1e-3) << dim;
      }
  }
}

class Moves : public LinksMethod {
 protected:
  // As no player could: through walls and through other cubes.
  static void nudge(glm::vec3& offset, std::mt19937& random) {
    const auto step = [&] { return 0.3f * (static_cast<float>(random() % 1001) / 500 - 1); };
    offset = glm::clamp(offset + glm::vec3(step(), step(), step()), -1.0f, 1.0f);
  }
  const scene::Scene scene_ = cornell();
  const Settings settings_{.size = 64, .psf = 96};
};

TEST_F(Moves, AMovedBodyIsLinkedAsAFreshStartWould) {
  const auto links = make_light_field("links", device(), scene_, settings_);
  auto offsets = at_rest(scene_);
  settled(*links, offsets);
  offsets[1] = {-0.5f, 0.4f, 0};
  offsets[2] = {0.3f, -0.2f, 0.1f};
  settled(*links, offsets);
  const auto afresh = fresh(scene_, settings_, offsets);
  EXPECT_LT(rel_rmse(links->irradiance(), afresh), 2e-3);
  EXPECT_GT(rel_rmse(fresh(scene_, settings_), afresh), 0.02) << "the move must matter";
}

TEST_F(Moves, ManyMovesLeaveNoTrace) {
  const auto links = make_light_field("links", device(), scene_, settings_);
  auto offsets = at_rest(scene_);
  settled(*links, offsets);
  std::mt19937 random(1);
  for (int move = 0; move < 1000; ++move) {
    const auto body = 1 + random() % 2;
    nudge(offsets[body], random);
    stepped(*links, offsets);
  }
  settled(*links, offsets);
  EXPECT_LT(rel_rmse(links->irradiance(), fresh(scene_, settings_, offsets)), 2e-3);
  const auto check = links->check_links(settings_.psf);
  EXPECT_GT(check.links, 0u);
  // The cubes also went through walls and through each other, as no player's can.
  EXPECT_LE(static_cast<double>(check.differing), 1e-4 * static_cast<double>(check.links));
  settled(*links, at_rest(scene_));
  EXPECT_LT(rel_rmse(links->irradiance(), fresh(scene_, settings_)), 2e-3);
}

// Kept links are compared with what is found now, pair by pair, until all have been; a move starts anew.
TEST_F(Moves, LinksAreLookedAtAgain) {
  const auto links = make_light_field("links", device(), scene_, settings_);
  auto offsets = at_rest(scene_);
  EXPECT_EQ(links->check_links(2).links, 0u) << "there are none yet";
  const auto solution = settled(*links, offsets);
  std::uint64_t misses = 0, looked_at = 0;
  for (std::uint32_t pair = 0; pair < settings_.psf / 2; pair += 2) {
    const auto check = links->check_links(2);
    EXPECT_GT(check.links, 0u);
    EXPECT_EQ(check.differing, 0u) << "pair " << pair << ": nothing has moved";
    misses += check.misses;
    looked_at += check.links;
  }
  EXPECT_EQ(misses, solution.misses);
  EXPECT_EQ(looked_at, std::uint64_t{solution.texels_valid} * settings_.psf / 2);
  EXPECT_EQ(links->check_links(2).links, 0u);
  offsets[1].x -= 0.3f;
  settled(*links, offsets);
  const auto after = links->check_links(settings_.psf);
  EXPECT_EQ(after.links, looked_at);
  EXPECT_EQ(after.differing, 0u);
  EXPECT_LT(rel_rmse(links->irradiance(), fresh(scene_, settings_, offsets)), 2e-3);
}

// Where nothing reflects there is nothing but direct light, of two lamps here: in a step it is there at once,
// whichever part of the directions the step's bounce is over, and whatever came and went before has left
// nothing behind.
TEST_F(Moves, DirectLightFollowsAtOnce) {
  auto black = scene_;
  for (auto& material : black.materials) material.base_colour = glm::vec3(0);
  black.materials[black.surfaces.back().material].emission = {1, 2, 3};  // of a cube
  for (const auto direct : {Direct::psf, Direct::exact}) {
    auto settings = settings_;
    settings.links.step_bounces = 0.125f;
    settings.direct = direct;
    const auto links = make_light_field("links", device(), black, settings);
    auto offsets = at_rest(black);
    settled(*links, offsets);
    std::mt19937 random(2);
    for (int move = 0; move < 100; ++move) {
      for (std::size_t body = 1; body < offsets.size(); ++body)  // through each other, too
        nudge(offsets[body], random);
      stepped(*links, offsets);
    }
    const auto afresh = fresh(black, settings, offsets);
    for (int part = 0; part < 8; ++part) {  // all that is left: by now each part knows which directions count
      offsets[1].x += 1e-6f;
      stepped(*links, offsets);
    }
    const auto kept = links->irradiance();
    EXPECT_LT(rel_rmse(kept, afresh), 1e-3);
    settled(*links, offsets);
    EXPECT_LT(rel_rmse(kept, links->irradiance()), 1e-5) << "one link too much or too little would be 3e-4";
    EXPECT_GT(rel_rmse(fresh(black, settings), afresh), 0.02) << "the moves must matter";
  }
}

// Parts of the directions a step: each map is on its way to where all of them lead.
TEST_F(Moves, PartBouncesFollowAndArrive) {
  auto offsets = at_rest(scene_);
  offsets[1].x -= 0.3f;
  const auto afresh = fresh(scene_, settings_, offsets);
  std::map<float, double> missing;
  for (const float bounces : {0.125f, 0.25f, 0.5f, 1.0f, 2.0f}) {
    auto settings = settings_;
    settings.links.step_bounces = bounces;
    const auto links = make_light_field("links", device(), scene_, settings);
    settled(*links, at_rest(scene_));
    const double before = rel_rmse(links->irradiance(), afresh);
    EXPECT_EQ(stepped(*links, offsets).bounces, bounces < 1 ? 1 : bounces);
    missing[bounces] = rel_rmse(links->irradiance(), afresh);
    EXPECT_LT(missing[bounces], 0.8 * before);
    settled(*links, offsets);
    EXPECT_LT(rel_rmse(links->irradiance(), afresh), 2e-3);
  }
  EXPECT_GT(missing[0.125f], missing[0.25f]);
  EXPECT_LT(missing[0.125f], 2.2 * missing[1.0f]) << "beside what has moved all directions count";
  EXPECT_GT(missing[0.25f], missing[0.5f]);
  EXPECT_GT(missing[0.5f], missing[1.0f]);
  EXPECT_GT(missing[1.0f], missing[2.0f]);
}

// A body that leaves the room makes the scene's sphere, and so all rasters, larger.
TEST_F(Moves, AMoveThatWidensTheSceneIsLinkedAfresh) {
  const auto links = make_light_field("links", device(), scene_, settings_);
  auto offsets = at_rest(scene_);
  settled(*links, offsets);
  offsets[1] = {0, 20, 0};
  settled(*links, offsets);
  EXPECT_LT(rel_rmse(links->irradiance(), fresh(scene_, settings_, offsets)), 2e-3);
}

TEST_F(Moves, LightSettlesAndThenNothingIsDone) {
  const auto links = make_light_field("links", device(), scene_, settings_);
  auto offsets = at_rest(scene_);
  settled(*links, offsets);
  EXPECT_EQ(stepped(*links, offsets, [](std::uint32_t) { return false; }).bounces, 0u);
  offsets[1].x -= 0.3f;
  EXPECT_EQ(stepped(*links, offsets).bounces, 1u);
  EXPECT_EQ(links->light(), Light::rising);
  int maps = 0;
  for (; links->light() != Light::settled; ++maps)
    stepped(*links, offsets, [](std::uint32_t bounces) { return bounces >= 10; });
  EXPECT_LE(maps, 3);
  EXPECT_LT(rel_rmse(links->irradiance(), fresh(scene_, settings_, offsets)), 2e-3);
  const auto calls = links->times().passes.at("gather").calls;
  EXPECT_EQ(stepped(*links, offsets, [](std::uint32_t) { return false; }).bounces, 0u);
  EXPECT_EQ(links->times().passes.at("gather").calls, calls);
}

TEST_F(LinksMethod, LayersBeyondTheLimitAreCountedAndLinkedAllTheSame) {
  SceneBuilder builder;
  const int dark = builder.material(glm::vec3(0)), bright = builder.material(glm::vec3(0), glm::vec3(10));
  square(builder, "floor", -1, false, chart_a, dark);
  for (int plate = 0; plate < 11; ++plate) {  // the nearest is drawn last: the first to be lost
    const float u = 0.02f + 0.08f * static_cast<float>(plate);
    square(builder, "plate", 1 - 0.1f * static_cast<float>(plate), true, {u, 0.6f, u + 0.06f, 0.9f},
           plate == 10 ? bright : dark);
  }
  const auto scene = loaded(builder);
  const Settings roomy{.size = 64, .psf = 96, .bounces = 1, .layers = 16},
      tight{.size = 64, .psf = 96, .bounces = 1, .layers = 1};
  const auto links = make_light_field("links", device(), scene, tight);
  const auto solution = settled(*links, at_rest(scene));
  EXPECT_GE(solution.depth_layers_max, 11u);
  EXPECT_GT(solution.overflow_pixels, 0u);
  EXPECT_EQ(rel_rmse(links->irradiance(), fresh(scene, roomy)), 0);
}

TEST_F(LinksMethod, DoubleSidedLampsShineBothWaysAndNotOnThemselves) {
  for (const bool double_sided : {false, true}) {
    SceneBuilder builder;
    square(builder, "lamp", 1, false, chart_a,
           builder.material(glm::vec3(0), glm::vec3(10), double_sided));  // faces up
    square(builder, "floor", -1, false, chart_b, builder.material(glm::vec3(0.5)));
    const auto scene = loaded(builder);
    const Settings settings{.size = 64,
                            .psf = 384,
                            .bounces = 1,
                            .thesis = {.abuffer = ABuffer::list, .sort = Sort::scan},
                            .direct = Direct::psf};
    const auto thesis = make_light_field("thesis", device(), scene, settings);
    settled(*thesis, at_rest(scene));
    const auto found = fresh(scene, settings);
    if (double_sided) {
      EXPECT_LT(rel_rmse(found, thesis->irradiance()), 0.05);
    }
    for (std::size_t texel = 0; texel < found.size(); ++texel)
      if (texel % 64 < 32) {
        ASSERT_EQ(found[texel].g, 0) << "the lamp's texels see nothing, least of all themselves";
      }
  }
}

// Walls on another triangle say nothing of rays that see nothing: a box out of the floor's sight stands right
// below it, or beside it.
TEST_F(LinksMethod, WallsElsewhereDoNotMatter) {
  const auto light_over = [&](float x) {
    SceneBuilder builder;
    const int black = builder.material(glm::vec3(0));
    square(builder, "cellar", -3, false, chart_c, black, 2.5f);
    builder.box("box", {x - 0.5f, -3, -0.7f}, {x + 0.5f, -2, 0.7f}, chart_d, black);
    square(builder, "lamp", 1, true, chart_a, builder.material(glm::vec3(0), glm::vec3(10)));
    square(builder, "floor", -1, false, chart_b, builder.material(glm::vec3(0.5)));
    return fresh(loaded(builder), {.size = 64, .psf = 384, .bounces = 1});
  };
  const auto below = light_over(0), beside = light_over(1.8f);
  for (std::size_t texel = 0; texel < below.size(); ++texel)
    if (texel % 64 >= 32 && texel / 64 < 32) {
      ASSERT_EQ(below[texel], beside[texel]) << texel % 64 << ", " << texel / 64;
    }
}

TEST_F(LinksMethod, NothingThatEmitsGivesBlack) {
  const auto scene = furnace(0.5f, 0);
  const auto links = make_light_field("links", device(), scene, {.size = 32, .psf = 24});
  EXPECT_EQ(settled(*links, at_rest(scene)).residual, 0);
  for (const auto& texel : links->irradiance()) ASSERT_EQ(glm::vec3(texel), glm::vec3(0));
}

TEST_F(LinksMethod, RadianceOfAnyMagnitudeScales) {
  for (const float emission : {1e-6f, 1e6f})
    for (const auto& texel : fresh(furnace(0.5f, emission), {.size = 32, .psf = 24, .bounces = 2}))
      if (texel.a > 0) {
        ASSERT_NEAR(texel.g / (emission * pi * 1.5), 1, 2e-3) << emission;
      }
}

}  // namespace
}  // namespace lichtveld::lightfield
