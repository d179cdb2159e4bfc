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

// On the host or on the device, whoever wants the other gets the same values.
TEST_F(TexelViews, BecomeEachOther) {
  std::vector<glm::vec4> values;
  for (int texel = 0; texel < 16 * 16; ++texel) values.emplace_back(texel, -texel, 0.5f * texel, 1);
  const auto first = atlas_image(device(), "test first", 16, vk::Format::eR32G32B32A32Sfloat),
             second = atlas_image(device(), "test second", 16, vk::Format::eR32G32B32A32Sfloat);
  const TexelView on_host(values, 16);
  on_host.copy_to(device(), first);
  const TexelView on_device(device(), first);
  EXPECT_EQ(on_device.width(), 16u);
  EXPECT_EQ(on_device.on_host(), values);
  on_device.copy_to(device(), second);
  EXPECT_EQ(TexelView(device(), second).on_host(), on_host.on_host());
}

}  // namespace
}  // namespace lichtveld::lightfield
