// --method reference and the renderer's rules: sides, contact, textures, bodies, settings, repeatability.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

#include <stdexcept>

#include "form_factors.hpp"
#include "reference_scenes.hpp"

namespace lichtveld::reference {
namespace {

using namespace lichtveld::testing;
using ::testing::HasSubstr;

TEST(ReferenceRules, OneSidedSurfacesAreSeenFromTheirFrontAlone) {
  for (const bool double_sided : {false, true}) {
    SceneBuilder builder;
    square(builder, "lamp", 2, false, chart_a, builder.material(glm::vec3(0), glm::vec3(10), double_sided));
    square(builder, "floor", 0, false, chart_b, builder.material(glm::vec3(0.5)));
    const auto baked = traced(loaded(builder), {.size = 32, .bounces = 3, .spp = 64});
    const double seen = double_sided ? 10 * pi * parallel_squares : 0;
    EXPECT_NEAR(baked.mean(chart_b).value, seen, 0.005 * seen);
    EXPECT_EQ(baked.mean(chart_a).value, 0) << "a double-sided lamp must not light itself";
  }
}

// A blind between lamp and floor lets light through its back, unless it is double-sided: for rays to lamps too.
TEST(ReferenceRules, TheBackOfABlindIsNotThere) {
  for (const bool double_sided : {false, true}) {
    SceneBuilder builder;
    square(builder, "lamp", 2, true, chart_a, builder.material(glm::vec3(0), glm::vec3(10)));
    square(builder, "floor", 0, false, chart_b, builder.material(glm::vec3(0)));
    square(builder, "blind", 1, false, chart_c, builder.material(glm::vec3(0), glm::vec3(0), double_sided), 5);
    const auto baked = traced(loaded(builder), {.size = 32, .bounces = 2, .spp = 64});
    const double seen = double_sided ? 0 : 10 * pi * parallel_squares;
    EXPECT_NEAR(baked.mean(chart_b).value, seen, 0.005 * seen);
  }
}

// A double-sided sheet reflects what falls on the side that is looked at: lit from above, it is dark from
// below.
TEST(ReferenceRules, ADoubleSidedSheetReflectsOnTheSideThatWasHit) {
  const auto below = [](float lamp_at, bool down) {
    SceneBuilder builder;
    square(builder, "lamp", lamp_at, down, chart_a, builder.material(glm::vec3(0), glm::vec3(10)), 0.5f);
    square(builder, "sheet", 2, false, chart_b, builder.material(glm::vec3(0.8f), glm::vec3(0), true), 4);
    square(builder, "floor", 0, false, chart_c, builder.material(glm::vec3(0)));
    return traced(loaded(builder), {.size = 32, .bounces = 2, .spp = 64}).mean(chart_c).value;
  };
  EXPECT_EQ(below(3, true), 0);
  EXPECT_GT(below(0.5f, false), 0.1) << "from the floor up through the lamp's back, the sheet's lower side";
}

// A lid that lies on the floor hides it, wherever the scene stands; with a gap it shades as any other.
TEST(ReferenceRules, ASurfaceInContactBlocksTheLight) {
  for (const float height : {-1.0f, 0.3f, 1000.1f})
    for (const bool double_sided : {false, true}) {
      SceneBuilder builder;
      square(builder, "lamp", height + 2, true, chart_a, builder.material(glm::vec3(0), glm::vec3(10)));
      square(builder, "floor", height, false, chart_b,
             builder.material(glm::vec3(0.5), glm::vec3(0), double_sided));
      square(builder, "lid", height, true, chart_c, builder.material(glm::vec3(0.5)));
      const auto baked = traced(loaded(builder), {.size = 32, .bounces = 2, .spp = 64});
      EXPECT_LT(baked.mean(chart_b).value, 1e-3 * 10 * pi * parallel_squares) << height;
    }
}

// A room without a lamp inside a bright one, behind walls as thin as 1e-5 of the room: not one path finds a way
// through.
TEST(ReferenceRules, ASealedDarkRoomIsBlack) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.8f));
  builder.box("dark room", glm::vec3(-1), glm::vec3(1), {0, 0, 1, 0.5f}, grey, true);
  builder.box("its outside", glm::vec3(-1.00002f), glm::vec3(1.00002f), {0, 0.5f, 0.5f, 1}, grey);
  builder.box("bright room", glm::vec3(-2), glm::vec3(2), {0.5f, 0.5f, 1, 1},
              builder.material(glm::vec3(0.5f), glm::vec3(1e6f)), true);
  const auto baked = traced(loaded(builder), {.size = 64, .spp = 256});
  baked.each({0, 0, 1, 0.5f}, [](float, float, const glm::vec3& irradiance, double error) {
    ASSERT_EQ(irradiance, glm::vec3(0));
    ASSERT_EQ(error, 0);
  });
  EXPECT_GT(baked.mean({0.5f, 0.5f, 1, 1}).value, 3e6);
}

TEST(ReferenceRules, OneBounceHasNoReflection) {
  const auto light = [](float albedo, std::uint32_t bounces) {
    SceneBuilder builder;
    builder.box("room", glm::vec3(-1), glm::vec3(1), {0, 0, 1, 0.5f}, builder.material(glm::vec3(albedo)),
                true);
    square(builder, "lamp", 0.9f, true, chart_c, builder.material(glm::vec3(0), glm::vec3(10)), 0.3f);
    return traced(loaded(builder), {.size = 32, .bounces = bounces, .spp = 16}).mean({0, 0, 1, 0.5f}).value;
  };
  EXPECT_EQ(light(0.9f, 1), light(0, 1));
  EXPECT_EQ(light(0, 2), light(0, 1));
  EXPECT_GT(light(0.9f, 2), 1.2 * light(0.9f, 1));
}

TEST(ReferenceRules, AShadowFollowsItsCube) {
  SceneBuilder builder;
  square(builder, "lamp", 2, true, chart_a, builder.material(glm::vec3(0), glm::vec3(10)));
  square(builder, "floor", 0, false, chart_b, builder.material(glm::vec3(0.5)));
  builder.set_movable(builder.box("cube", {-0.3f, 0.1f, -0.3f}, {0.3f, 0.4f, 0.3f}, chart_c,
                                  builder.material(glm::vec3(0.2f))));
  const auto scene = loaded(builder);
  constexpr float middle = (chart_b.u0 + chart_b.u1) / 2;
  const Chart left{chart_b.u0, chart_b.v0, middle, chart_b.v1},
      right{middle, chart_b.v0, chart_b.u1, chart_b.v1};
  const Settings settings{.size = 32, .bounces = 1, .spp = 256};
  const auto to_left = traced(scene, settings, {glm::vec3(0), glm::vec3(-0.6f, 0, 0)});
  const auto to_right = traced(scene, settings, {glm::vec3(0), glm::vec3(0.6f, 0, 0)});
  EXPECT_LT(to_left.mean(left).value, 0.9 * to_left.mean(right).value);
  EXPECT_NEAR(to_left.mean(left).value / to_right.mean(right).value, 1, 0.005);
  EXPECT_NEAR(to_left.mean(right).value / to_right.mean(left).value, 1, 0.005);
}

// A furnace papered with a chequered texture of sRGB 188 and 0, that is 0.5 (0.5029) and 0, seen at bilinear
// seams: on average each wall reflects a half of a half.
TEST(ReferenceRules, TexturesAreDecodedFilteredAndTimesTheBaseColour) {
  SceneBuilder builder;
  const int room = builder.box("room", glm::vec3(-1), glm::vec3(1), {0, 0, 1, 1},
                               builder.material({0.5f, 1, 1}, glm::vec3(1)), true);
  std::vector<glm::vec2> colour;  // four repeats of 2 x 2 pixels a wall, from a corner outside 0..1
  for (int face = 0; face < 6; ++face)
    for (const glm::vec2 corner :
         {glm::vec2(-1.25f, 3), glm::vec2(2.75f, 3), glm::vec2(2.75f, 7), glm::vec2(-1.25f, 7)})
      colour.push_back(corner);
  builder.primitive(room)["attributes"]["TEXCOORD_0"] = builder.accessor(colour, 5126, "VEC2");

  const std::array<std::uint8_t, 12> pixels = {188, 188, 188, 0, 0, 0, 0, 0, 0, 188, 188, 188};
  std::vector<unsigned char> png;
  OIIO::Filesystem::IOVecOutput memory(png);
  const auto output = OIIO::ImageOutput::create("png", &memory);
  ASSERT_TRUE(output && output->open("memory.png", OIIO::ImageSpec(2, 2, 3, OIIO::TypeDesc::UINT8)));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) && output->close());
  const int view = builder.gltf["bufferViews"].size();
  builder.accessor(png, 5121, "SCALAR");
  builder.gltf["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
  builder.gltf["textures"] = {{{"source", 0}}};
  builder.gltf["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};

  const auto baked = traced(loaded(builder), {.size = 32, .bounces = 2, .spp = 256});
  glm::dvec3 sum(0);
  baked.each(whole_atlas, [&](float, float, const glm::vec3& irradiance, double) { sum += irradiance; });
  sum /= baked.light.texels_valid;
  const double mean_texture = std::pow((188 / 255.0 + 0.055) / 1.055, 2.4) / 2;
  EXPECT_NEAR(sum.r / pi, 1 + 0.5 * mean_texture, 0.002);
  EXPECT_NEAR(sum.g / pi, 1 + mean_texture, 0.002);
}

TEST(ReferenceRules, RepeatsBitForBitOnAnyNumberOfThreads) {
  const auto cornell = scene::load(LICHTVELD_SOURCE_DIR "/assets/cornell.glb");
  Settings settings{.size = 32, .spp = 20, .seed = 7, .threads = 1};
  const auto one = trace(cornell, {}, settings);
  settings.threads = 2;
  const auto two = trace(cornell, {}, settings);
  EXPECT_EQ(one.texels, two.texels);
  EXPECT_EQ(one.standard_error, two.standard_error);
  EXPECT_EQ(one.rays, two.rays);
  EXPECT_EQ(one.misses, two.misses);
  settings.seed = 8;
  EXPECT_NE(trace(cornell, {}, settings).texels, one.texels);
}

TEST(ReferenceRules, FewPathsAndOddCountsWork) {
  for (const std::uint32_t spp : {1u, 2u, 17u, 100u}) {
    const auto baked = traced(furnace(0.5f), {.size = 16, .bounces = 2, .spp = spp});
    EXPECT_NEAR(baked.mean(whole_atlas).value / (1.5 * pi), 1, 0.15) << spp;
    EXPECT_EQ(std::isinf(baked.mean(whole_atlas).standard_error), spp == 1);
  }
}

TEST(ReferenceRules, SettingsOutOfRangeAreRefusedByName) {
  const auto scene = furnace(0.5f);
  const auto refusal = [&](const Settings& settings,
                           const std::vector<glm::vec3>& offsets = {}) -> std::string {
    try {
      trace(scene, offsets, settings);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_THAT(refusal({.size = 15}), HasSubstr("16..4096"));
  EXPECT_THAT(refusal({.size = 4097}), HasSubstr("16..4096"));
  EXPECT_THAT(refusal({.spp = 0}), HasSubstr("1..1000000"));
  EXPECT_THAT(refusal({.spp = 1'000'001}), HasSubstr("1..1000000"));
  EXPECT_THAT(refusal({.bounces = 0}), HasSubstr("0 bounces"));
  EXPECT_THAT(refusal({.size = 16, .spp = 1}, {glm::vec3(0, NAN, 0)}), HasSubstr("finite"));
}

}  // namespace
}  // namespace lichtveld::reference
