// What holds of every engine, through the interface alone.
#include <gmock/gmock.h>

#include "device_for_tests.hpp"
#include "known_scenes.hpp"
#include "lichtveld/lightfield/presenter.hpp"
#include "lichtveld/reference/error.hpp"
#include "light_fields.hpp"
#include "passes/light_map.hpp"

namespace lichtveld::lightfield {
namespace {

using namespace lichtveld::testing;
using ::testing::AllOf;
using ::testing::HasSubstr;

class EveryEngine : public WithDevice, public ::testing::WithParamInterface<const Engine*> {
 protected:
  std::unique_ptr<LightField> make(const scene::Scene& scene, const Settings& settings) {
    return GetParam()->make(device(), scene, settings);
  }
};

scene::Scene cornell() {
  return scene::load(LICHTVELD_SOURCE_DIR "/assets/cornell.glb");
}

TEST_P(EveryEngine, KnowsWhatItsLightBelongsTo) {
  const auto scene = cornell();
  const auto light = make(scene, {.size = 32, .psf = 24});
  EXPECT_EQ(light->light(), Light::unknown);
  auto offsets = at_rest(scene);
  light->place(offsets);
  EXPECT_EQ(light->light(), Light::unknown) << "nothing has been computed yet";
  EXPECT_GT(light->settle().bounces, 0u);
  EXPECT_EQ(light->light(), Light::settled);
  light->place(offsets);
  EXPECT_EQ(light->light(), Light::settled) << "nothing has moved";
  EXPECT_EQ(light->step([](std::uint32_t) { return true; }).bounces, 0u);
  offsets[1].x -= 0.3f;
  light->place(offsets);
  EXPECT_EQ(light->light(), Light::moved);
  EXPECT_GT(light->step([](std::uint32_t) { return true; }).bounces, 0u);
  EXPECT_TRUE(light->light() == Light::rising || light->light() == Light::settled);
  light->settle();
  const auto fresh = make(scene, {.size = 32, .psf = 24});
  EXPECT_LT(reference::error_of(light->irradiance(), (settled(*fresh, offsets), fresh->irradiance())).rel_rmse,
            2e-3);
}

TEST_P(EveryEngine, ThereAndBackIsWhereItBegan) {
  const auto scene = cornell();
  const auto light = make(scene, {.size = 32, .psf = 24, .bounces = 2});
  settled(*light, at_rest(scene));
  const auto before = light->irradiance();
  auto offsets = at_rest(scene);
  offsets[1] = {-0.4f, 0.2f, 0.1f};
  settled(*light, offsets);
  EXPECT_NE(light->irradiance(), before);
  settled(*light, at_rest(scene));
  EXPECT_EQ(light->irradiance(), before);
}

TEST_P(EveryEngine, ShowsWhatPresentingItsIrradianceShows) {
  const auto scene = furnace(0.5f, 3);
  const auto light = make(scene, {.size = 32, .psf = 24, .bounces = 2});
  light->settle();
  const auto shown = light->shown();
  EXPECT_EQ(shown.format, Shown::Format::srgb8);
  EXPECT_EQ(shown.size, 32u);
  ASSERT_EQ(shown.bytes.size(), 4u * 32 * 32);
  const auto irradiance = light->irradiance();
  EXPECT_EQ(present(device(), scene, {irradiance, 32}).bytes, shown.bytes);
}

// Twice as bright a room is two maps later as bright as the first was shown.
TEST_P(EveryEngine, ItsExposureFollowsAsAnEyeDoes) {
  const auto scene = furnace(0.5f);
  const Settings settings{.size = 32, .psf = 24, .bounces = 2, .direct = Direct::exact};
  const auto light = make(scene, settings);
  light->settle();
  const auto before = light->shown();
  EXPECT_TRUE(before.adapted);
  light->dim({glm::vec3(4)});
  light->settle();
  const Adaptation slow{.brighter = 0.5f, .darker = 0.9f};
  const auto at_once = light->shown(slow);
  EXPECT_NEAR(std::log2(at_once.average / before.average), 1, 0.05) << "half of the way of two powers";
  EXPECT_FALSE(at_once.adapted);
  EXPECT_GT(at_once.bytes[4 * 32 * 16 + 4 * 16], before.bytes[4 * 32 * 16 + 4 * 16]);
  auto last = light->shown(slow);
  EXPECT_NEAR(std::log2(last.average / before.average), 1.5, 0.05);
  for (int maps = 0; maps < 20 && !last.adapted; ++maps) last = light->shown(slow);
  EXPECT_TRUE(last.adapted);
  EXPECT_NEAR(std::log2(last.average / before.average), 2, 0.05);
  light->dim({glm::vec3(1)});
  light->settle();
  EXPECT_NEAR(std::log2(light->shown(slow).average / before.average), 1.8, 0.05) << "to the dark it is slower";
  const auto fixed = light->shown({.fixed = 3.0f});
  EXPECT_NEAR(fixed.average, 3, 1e-3);
  EXPECT_EQ(light->shown({.fixed = 3.0f}).bytes, fixed.bytes);
  // What is shown is what the host says such a radiance looks like.
  const auto irradiance = light->irradiance();
  const auto lit = std::ranges::find_if(irradiance, [](const glm::vec4& e) { return e.a > 0; });
  const auto at = static_cast<std::size_t>(lit - irradiance.begin());
  const float radiance = 1 + 0.5f / static_cast<float>(testing::pi) * lit->g;
  EXPECT_NEAR(255 * displayed(glm::vec3(radiance), fixed).g, fixed.bytes[4 * at + 1], 1);
  EXPECT_LT(fixed.bytes[4 * at + 1], 200);
}

TEST_P(EveryEngine, RefusesWhatCannotBe) {
  const auto scene = furnace(0.5f);
  EXPECT_THROW(make(scene, {.size = 8}), std::invalid_argument);
  const auto light = make(scene, {.size = 32, .psf = 24});
  EXPECT_THROW(light->place({}), std::invalid_argument) << "one offset a body";
}

TEST_P(EveryEngine, SaysWhatItHasTaken) {
  const auto scene = furnace(0.5f);
  const auto light = make(scene, {.size = 32, .psf = 24, .bounces = 1});
  light->settle();
  light->shown();
  const auto times = light->times();
  EXPECT_GT(times.host.at("texel_records").ms, 0);
  if (GetParam()->name == std::string_view("rays")) {
    for (const char* stage : {"links", "direct_light", "bounces"}) EXPECT_GT(times.host.at(stage).ms, 0) << stage;
    return;
  }
  EXPECT_GT(times.passes.at("geometry_texture").calls, 0u);
  EXPECT_GT(times.passes.at("tone_map").gpu_ms, 0);
  EXPECT_GT(times.host.at("pipelines").calls, 5u);
}

std::vector<const Engine*> all_engines() {
  std::vector<const Engine*> all;
  for (const auto& one : engines()) all.push_back(&one);
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, EveryEngine, ::testing::ValuesIn(all_engines()),
                         [](const auto& one) { return std::string(one.param->name); });

TEST(Engines, AreFoundByName) {
  EXPECT_STREQ(engines().front().name, "thesis") << "the others are measured against it";
  for (const auto& one : engines()) EXPECT_EQ(&engine(one.name), &one);
  try {
    engine("magic");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("magic"), HasSubstr("thesis"), HasSubstr("links")));
  }
}

using TexelViews = WithDevice;

TEST_F(TexelViews, AreReadFromWhereverTheyAre) {
  std::vector<glm::vec4> values;
  for (int texel = 0; texel < 16 * 16; ++texel) values.emplace_back(texel, -texel, 0.5f * texel, 1);
  const auto image = atlas_image(device(), "test", 16, vk::Format::eR32G32B32A32Sfloat);
  gpu::fill<glm::vec4>(device(), image, values);
  EXPECT_EQ(TexelView(values, 16).on_host(), values);
  EXPECT_EQ(TexelView(device(), image).width(), 16u);
  EXPECT_EQ(TexelView(device(), image).on_host(), values);
}

}  // namespace
}  // namespace lichtveld::lightfield
