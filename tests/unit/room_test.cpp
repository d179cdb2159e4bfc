// The live room without a network: moves, settling, and what goes wrong.
#include <gmock/gmock.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "device_for_tests.hpp"
#include "lichtveld/room/room.hpp"
#include "lichtveld/scene/lights.hpp"
#include "lichtveld/scene/motion.hpp"
#include "light_fields.hpp"
#include "lighting.hpp"

namespace lichtveld::room {
namespace {

using namespace std::chrono_literals;
using testing::at_rest;
using ::testing::HasSubstr;
using testing::settled;

// Takes maps as a server would.
class Audience {
 public:
  void take(Map map) {
    const std::lock_guard lock(mutex_);
    maps_.push_back(std::move(map));
    came_.notify_all();
  }
  // The newest map once there are so many; fails where they do not come.
  Map wait_for(std::size_t count) {
    std::unique_lock lock(mutex_);
    if (!came_.wait_for(lock, 30s, [&] { return maps_.size() >= count; }))
      throw std::runtime_error("only " + std::to_string(maps_.size()) + " maps came");
    return maps_.back();
  }
  Map newest() {
    const std::lock_guard lock(mutex_);
    return maps_.back();
  }
  std::size_t count() {
    const std::lock_guard lock(mutex_);
    return maps_.size();
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::vector<Map> maps_;
};

class LiveRoom : public testing::WithDevice {
 protected:
  std::unique_ptr<lightfield::LightField> light() {
    return lightfield::make_light_field("links", device(), scene_, settings_);
  }
  // What a fresh start shows with the bodies there.
  std::vector<std::uint8_t> shown_at(const Places& places) {
    const auto fresh = light();
    settled(*fresh, offsets_of(scene_, places));
    return fresh->shown().bytes;
  }

  const scene::Scene scene_ = scene::load(LICHTVELD_SOURCE_DIR "/assets/cornell.glb");
  const lightfield::Settings settings_{.size = 32, .psf = 24};
};

// Runs a room beside the test, which leaves the device alone meanwhile.
class Running {
 public:
  explicit Running(Room& room) : room_(room), thread_([&room] { room.run(); }) {}
  ~Running() { room_.stop(); }

 private:
  Room& room_;
  std::jthread thread_;
};

double difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(int{a[i]} - int{b[i]});
  return sum / static_cast<double>(a.size());
}

TEST_F(LiveRoom, ShowsTheRoomAtRestAndThenFollowsItsBodies) {
  Audience audience;
  Room room(scene_, light(), {.rate = 1000, .publish = [&](Map map) { audience.take(std::move(map)); }});
  room.begin();
  auto places = places_at_rest(scene_);
  const auto first = audience.wait_for(1);
  EXPECT_EQ(first.places, places);
  EXPECT_EQ(first.shown.size, settings_.size);
  EXPECT_EQ(first.shown.bytes, shown_at(places));

  {
    const Running running(room);
    for (const auto direction : {Direction::left, Direction::up, Direction::left}) {
      places[0] = room.stepped(places, 0, direction);
      room.place(places);
    }
    while (room.work().counts.empty())
      std::this_thread::sleep_for(10ms);  // links are looked at once it has settled
    const auto count = audience.count();
    std::this_thread::sleep_for(200ms);
    EXPECT_EQ(audience.count(), count) << "nothing moves, so nothing is sent";
  }
  const auto last = audience.newest();
  EXPECT_EQ(last.places, places);
  EXPECT_LT(difference(last.shown.bytes, shown_at(places)), 0.05) << "of 255: it has all the light";
  EXPECT_GT(difference(first.shown.bytes, last.shown.bytes), 0.2) << "the moves must matter";
}

// The lamp is switched off and on again; what is shown is what a fresh start with such a lamp shows.
TEST_F(LiveRoom, FollowsItsLights) {
  auto scene = scene_;
  scene.lights.push_back({.node = "lamp", .switchable = true});
  for (auto& surface : scene.surfaces) surface.light = 1;
  const auto fresh = [&](const scene::Scales& scales) {
    const auto dim = scene::dimmed(scene, scales);
    const auto light = lightfield::make_light_field("rays", device(), dim, settings_);
    settled(*light, at_rest(scene_));
    return light->shown().bytes;
  };
  const scene::Scales blue = {glm::vec3(1), {0.1f, 0.2f, 0.9f}}, full = {glm::vec3(1), glm::vec3(1)};
  const auto of_blue = fresh(blue), of_full = fresh(full);
  ASSERT_GT(difference(of_blue, of_full), 5);
  Audience audience;
  Room room(scene, lightfield::make_light_field("rays", device(), scene, settings_),
            {.rate = 1000, .scales = blue, .publish = [&](Map map) { audience.take(std::move(map)); }});
  room.begin();
  EXPECT_EQ(audience.wait_for(1).shown.bytes, of_blue);
  {
    const Running running(room);
    room.dim(full);
    audience.wait_for(2);
    auto count = audience.count() - 1;
    while (std::exchange(count, audience.count()) != audience.count()) std::this_thread::sleep_for(300ms);
  }
  EXPECT_LT(difference(audience.newest().shown.bytes, of_full), 0.05);
}

TEST_F(LiveRoom, ACandleNeverRests) {
  auto scene = scene_;
  scene.lights.push_back({.node = "lamp", .flicker = 0.5f});
  for (auto& surface : scene.surfaces) surface.light = 1;
  Audience audience;
  Room room(scene, lightfield::make_light_field("rays", device(), scene, settings_),
            {.rate = 1000, .publish = [&](Map map) { audience.take(std::move(map)); }});
  room.begin();
  const Running running(room);
  audience.wait_for(10);
}

TEST(Lighting, ACandleComesAndGoesWithinItsShare) {
  float least = 1, most = 0;
  for (double t = 0; t < 100; t += 0.01) {
    const float now = flicker(0.4f, t);
    ASSERT_GE(now, 0.6f - 1e-5f);
    ASSERT_LE(now, 1 + 1e-5f);
    ASSERT_LT(std::abs(flicker(0.4f, t + 0.001) - now), 0.02f) << "without a step";
    least = std::min(least, now), most = std::max(most, now);
  }
  EXPECT_LT(least, 0.66f);
  EXPECT_GT(most, 0.94f);
}

TEST(Lighting, ADayHasItsNoonAndItsNight) {
  EXPECT_NEAR(daylight(12).g, 1, 1e-6);
  EXPECT_EQ(daylight(0), glm::vec3(0));
  EXPECT_EQ(daylight(23), glm::vec3(0));
  const auto evening = daylight(17.5);
  EXPECT_GT(evening.r, evening.g);
  EXPECT_GT(evening.g, evening.b);
  EXPECT_GT(evening.b, 0);
}

TEST_F(LiveRoom, EachUpdateIsHandedToWhatIsAroundIt) {
  Audience audience;
  std::size_t updates = 0;
  Room room(scene_, light(),
            {.rate = 1000,
             .publish = [&](Map map) { audience.take(std::move(map)); },
             .around_update =
                 [&](const std::function<void()>& update) {
                   update();
                   ++updates;
                 }});
  room.begin();
  EXPECT_EQ(updates, 1u);
  audience.wait_for(1);
}

// Any number of bodies moves, and those that are left out stand at rest.
TEST_F(LiveRoom, BodiesAreAList) {
  const auto rest = places_at_rest(scene_);
  ASSERT_EQ(rest.size(), 2u);
  EXPECT_EQ(offsets_of(scene_, {}), at_rest(scene_));
  EXPECT_EQ(offsets_of(scene_, rest), at_rest(scene_));
  const auto offsets = offsets_of(scene_, {rest[0] + glm::vec3(1, 2, 3)});
  EXPECT_LT(glm::distance(offsets[1], glm::vec3(1, 2, 3)), 1e-5);
  EXPECT_EQ(offsets[2], glm::vec3(0));
  EXPECT_THROW(offsets_of(scene_, Places(3)), std::invalid_argument);
}

// What is not among a room's bodies is not told of, and does not move.
TEST_F(LiveRoom, ListsTheBodiesThatItWasGiven) {
  Audience audience;
  Room room(scene_, light(), {.bodies = 1, .publish = [&](Map map) { audience.take(std::move(map)); }});
  room.begin();
  EXPECT_EQ(audience.wait_for(1).places, places_at_rest(scene_, 1));
  EXPECT_EQ(places_at_rest(scene_, 1).size(), 1u);
}

TEST_F(LiveRoom, AStepIsAStepLongAndEndsAtAWall) {
  auto places = places_at_rest(scene_);
  const float step = scene::step_length(scene_);
  const auto up = stepped(scene_, places, 1, Direction::up);
  EXPECT_LT(glm::distance(up, places[1] + glm::vec3(0, step, 0)), 1e-4);
  for (int steps = 0; steps < 100; ++steps) places[0] = stepped(scene_, places, 0, Direction::left);
  EXPECT_EQ(stepped(scene_, places, 0, Direction::left), places[0]) << "the wall";
  EXPECT_LT(places[0].x, places_at_rest(scene_)[0].x);
}

TEST_F(LiveRoom, WhatPublishingThrowsEndsIt) {
  Room room(scene_, light(),
            {.publish = [](const Map&) { throw std::runtime_error("the encoder is broken"); }});
  room.begin();
  try {
    room.run();
    FAIL() << "it went on";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("the encoder is broken"));
  }
}

TEST_F(LiveRoom, EndsWhenItIsAskedTo) {
  Audience audience;
  bool ended = false;
  Room room(scene_, light(),
            {.publish = [&](Map map) { audience.take(std::move(map)); }, .ended = [&] { return ended; }});
  room.stop();
  room.run();
  EXPECT_EQ(audience.count(), 0u);
  Room other(scene_, light(), {.publish = [](const Map&) {}, .ended = [&] { return ended; }});
  ended = true;
  other.run();
}

// A slow network must not make maps pile up: while one is published the newest places wait, and one map.
TEST_F(LiveRoom, OfWhatComesWhileItIsBusyTheNewestCounts) {
  Audience audience;
  Room room(scene_, light(), {.rate = 1000, .publish = [&](Map map) {
                                std::this_thread::sleep_for(50ms);
                                audience.take(std::move(map));
                              }});
  room.begin();
  const Running running(room);
  auto places = places_at_rest(scene_);
  for (int step = 0; step < 200; ++step) {
    places[0].x -= 0.002f;
    room.place(places);
  }
  Map last = audience.wait_for(2);
  for (std::size_t count = 2; last.places != places; ++count) {
    ASSERT_LT(count, 20u);
    last = audience.wait_for(count);
  }
}

TEST(RoomOptions, ThatMakeNoSenseAreRefused) {
  const scene::Scene scene{};
  EXPECT_THROW(Room(scene, nullptr, {.rate = 0, .publish = [](const Map&) {}}), std::invalid_argument);
  EXPECT_THROW(Room(scene, nullptr, {.publish = {}}), std::invalid_argument);
}

// A light field whose device has no memory left from some moment on. Real ones fail like that where a pixel
// turns out to have more layers than fit.
class Failing : public lightfield::LightField {
 public:
  Failing(const scene::Scene& scene, int& good) : LightField(scene, lightfield::Direct::exact), good_(good) {}
  std::vector<lightfield::Light> before;

  lightfield::TexelView irradiance_view() const override { return {std::span<const glm::vec4>(), 0}; }
  lightfield::Shown shown(const lightfield::Adaptation&) override { return {.size = 1, .bytes = {1, 2, 3, 4}}; }
  gpu::Times times() const override { return {}; }

 protected:
  bool compute(lightfield::Light was, const lightfield::Moves& moves, const Enough&,
               lightfield::Solution&) override {
    before.push_back(was);
    EXPECT_EQ(moves.all, was == lightfield::Light::unknown);
    if (good_-- <= 0) throw std::runtime_error("the device has no 12 MiB left");
    return true;
  }
  double error_estimate() const override { return 0; }

 private:
  int& good_;
};

TEST_F(LiveRoom, ADeviceOutOfMemoryEndsItWithItsWords) {
  int good = 1;
  Audience audience;
  Room room(scene_, std::make_unique<Failing>(scene_, good),
            {.publish = [&](Map map) { audience.take(std::move(map)); }});
  room.begin();
  audience.wait_for(1);
  auto places = places_at_rest(scene_);
  places[0].x -= 0.1f;
  room.place(places);
  try {
    room.run();
    FAIL() << "it went on";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("no 12 MiB left"));
  }
  EXPECT_EQ(audience.count(), 1u) << "no map of what could not be computed";
}

// What failed half-way is not gone on with: the next light starts afresh.
TEST_F(LiveRoom, AfterAFailureAllIsComputedAfresh) {
  int good = 1;
  Failing light(scene_, good);
  auto offsets = at_rest(scene_);
  settled(light, offsets);
  offsets[1].x = 1;
  light.place(offsets);
  EXPECT_THROW(light.settle(), std::runtime_error);
  EXPECT_EQ(light.light(), lightfield::Light::unknown);
  good = 1;
  light.settle();
  using enum lightfield::Light;
  EXPECT_EQ(light.before, (std::vector{unknown, moved, unknown}));
  EXPECT_EQ(light.light(), lightfield::Light::settled);
}

}  // namespace
}  // namespace lichtveld::room
