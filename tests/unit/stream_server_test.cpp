// Joining, maps, roles and moves over real connections.
#include "lichtveld/stream/protocol.hpp"
#include "stream_room.hpp"

namespace lichtveld::stream::test {
namespace {

// The suite ends with a look at what is left: the library must be able to end all its threads.
class Cleanup : public testing::Environment {
  void TearDown() override {
    EXPECT_EQ(rtc::Cleanup().wait_for(10s), std::future_status::ready) << "a connection is still alive";
  }
};
const auto* const cleanup = testing::AddGlobalTestEnvironment(new Cleanup);

TEST_F(RoomTest, JoinerGetsPlacesAtOnceAndTheWholeMap) {
  start();
  const auto first = map_bytes(100'001, 1), second = map_bytes(16 * 1024, 2);
  server->publish({.bytes = first, .places = rest});
  Client client(*relay);
  ASSERT_TRUE(client.wait_maps(1));
  EXPECT_EQ(client.state().maps[0], as_binary(first));
  EXPECT_EQ(client.state().texts.at(0), rest_text);
  EXPECT_GE(client.state().texts_before_first_chunk, 1u) << "the places come before the map";
  EXPECT_EQ(relay->scene(), std::string(64, 'a'));

  server->publish({.bytes = second, .places = {{0.125f, -1}, {0.5f, 0.25f}}});
  ASSERT_TRUE(client.wait_maps(2));
  EXPECT_EQ(client.state().maps[1], as_binary(second));
  EXPECT_EQ(client.state().texts.back(), "0.125!-1/0.5!0.25") << "the places that this map shows";
  ASSERT_TRUE(eventually([&] { return server->statistics().maps_sent == 2; }));
  const auto statistics = server->statistics();
  EXPECT_EQ(statistics.maps_skipped, 0u);
  EXPECT_GE(statistics.bytes_sent, first.size() + second.size());
}

TEST_F(RoomTest, WorkIsReportedWhenThereIsMoreOfIt) {
  auto with_work = options();
  with_work.work = [] {
    return Work{.stages = {{"encode", 2, 0.5}}, .passes = {{"gather", 4, 0.25}}, .counts = {{"links", 7}}};
  };
  server = std::make_unique<Server>(std::move(with_work));
  wait_connected();
  Client client(*relay);
  ASSERT_TRUE(client.wait([](const auto& s) { return s.texts.size() >= 1; }));
  ASSERT_TRUE(eventually([&] { return !relay->work().is_null(); }));
  const int reports = relay->reports;
  std::this_thread::sleep_for(1100ms);
  EXPECT_EQ(relay->reports, reports) << "nothing has been done since";

  server->publish({.bytes = map_bytes(1000, 1), .places = rest});
  ASSERT_TRUE(client.wait_maps(1));
  ASSERT_TRUE(eventually([&] { return relay->work().at("stages").at(1).at("runs") == 1; }));
  const auto work = relay->work();
  EXPECT_EQ(work.at("stages").at(0), (nlohmann::json{{"name", "encode"}, {"runs", 2}, {"seconds", 0.5}}));
  EXPECT_EQ(work.at("stages").at(1).at("name"), "send");
  EXPECT_GT(work.at("stages").at(1).at("seconds"), 0.0);
  EXPECT_EQ(work.at("counts").at(0), (nlohmann::json{{"name", "links"}, {"value", 7}}));
  EXPECT_EQ(work.at("counts").at(1), (nlohmann::json{{"name", "maps_sent"}, {"value", 1}}));
  EXPECT_EQ(work.at("passes"), (nlohmann::json{{{"name", "gather"}, {"runs", 4}, {"seconds", 0.25}}}));
}

TEST_F(RoomTest, LightsAreThePlayersAndTheNewestIsToldToWhoAsks) {
  auto with_lights = options();
  with_lights.lights = {{"lamp", {1, 1, 1}}, {"candle", {0, 0, 0}}};
  std::vector<Light> heard;
  with_lights.lights_changed = [&](const std::vector<Light>& lights) {
    const std::lock_guard lock(mutex);
    heard = lights;
  };
  server = std::make_unique<Server>(std::move(with_lights));
  wait_connected();
  Client player(*relay);
  ASSERT_TRUE(player.wait_cube(1));
  Client other(*relay);
  ASSERT_TRUE(other.wait_cube(2));
  Client watcher(*relay), quiet(*relay);
  ASSERT_TRUE(watcher.wait_cube(0));
  ASSERT_TRUE(quiet.wait_cube(0));
  const auto told = [](const std::string& text) {
    return [=](const auto& s) { return std::ranges::find(s.texts, text) != s.texts.end(); };
  };
  const std::string before = format_lights({{"lamp", {1, 1, 1}}, {"candle", {0, 0, 0}}}),
                    after = format_lights({{"lamp", {1, 1, 1}}, {"candle", {0.5f, 0.25f, 0}}});
  for (auto* client : {&player, &watcher}) {
    client->channel().send(std::string("lights"));
    ASSERT_TRUE(client->wait(told(before)));
  }
  player.channel().send(std::string("light 2 0.5 0.25 0"));
  ASSERT_TRUE(player.wait(told(after)));
  ASSERT_TRUE(watcher.wait(told(after)));
  {
    const std::lock_guard lock(mutex);
    EXPECT_EQ(heard.at(1).scale, (LightScale{0.5f, 0.25f, 0}));
  }
  watcher.channel().send(std::string("light 1 0"));
  ASSERT_TRUE(refused_at_least(1)) << "who watches switches nothing";
  player.channel().send(std::string("light 3 1"));
  ASSERT_TRUE(refused_at_least(2)) << "there is no third";
  EXPECT_EQ(server->statistics().dimmings, 1u);
  server->publish({.bytes = map_bytes(100, 1), .places = rest, .sky = "#102030"});
  const auto dark = format_lights({{"lamp", {1, 1, 1}}, {"candle", {0.5f, 0.25f, 0}}}, "#102030");
  ASSERT_TRUE(watcher.wait(told(dark))) << "the sky's colour comes with the map";
  EXPECT_FALSE(told(before)(quiet.state())) << "who has not asked is told nothing";
  EXPECT_FALSE(told(after)(quiet.state()));
}

TEST_F(RoomTest, AFloodOfDimmingsIsCutDown) {
  auto with_lights = options();
  with_lights.lights = {{"lamp", {1, 1, 1}}};
  server = std::make_unique<Server>(std::move(with_lights));
  wait_connected();
  Client player(*relay);
  ASSERT_TRUE(player.wait_cube(1));
  for (int i = 0; i < 60; ++i) player.channel().send("light 1 " + std::to_string(i % 2));
  ASSERT_TRUE(refused_at_least(10));
  EXPECT_LT(server->statistics().dimmings, 50u);
  EXPECT_EQ(server->statistics().peers, 1u) << "too much of it is no attack";
}

TEST_F(RoomTest, PlacesComeWithoutMapsAtLeastOnceASecond) {
  start();
  Client client(*relay);
  ASSERT_TRUE(client.wait([](const auto& s) { return s.texts.size() >= 1; }));
  const auto before = client.state().texts.size();
  std::this_thread::sleep_for(2100ms);
  EXPECT_GE(client.state().texts.size(), before + 2);
  EXPECT_THAT(client.state().texts, testing::Each(rest_text));
}

TEST_F(RoomTest, TwoPlayAndTheThirdInherits) {
  start();
  auto first = std::make_unique<Client>(*relay);
  ASSERT_TRUE(first->wait_cube(1));
  Client second(*relay);
  ASSERT_TRUE(second.wait_cube(2));
  Client third(*relay);
  ASSERT_TRUE(third.wait([](const auto& s) { return s.role.is_object(); }));
  EXPECT_EQ(third.state().role, (nlohmann::json{{"id", third.id()},
                                                {"type", "role"},
                                                {"cube", 0},
                                                {"players", 2},
                                                {"watchers", 1},
                                                {"session", third.session()}}));
  EXPECT_GE(third.session().size(), 32u);
  EXPECT_NE(third.session(), second.session());
  ASSERT_TRUE(first->wait([](const auto& s) { return s.role.at("watchers") == 1; }))
      << "everyone hears of a newcomer";

  first->channel().send(std::string("right"));
  second.channel().send(std::string("up"));
  third.channel().send(std::string("left"));
  ASSERT_TRUE(
      eventually([&] { return server->statistics().moves == 2 && server->statistics().moves_blocked == 1; }));
  EXPECT_EQ(last_change(), (std::vector<Place>{{-0.25f, 0}, {0.5f, 0.5f}}));

  for (int i = 0; i < 4; ++i) second.channel().send(std::string("right"));  // the wall is two steps away
  ASSERT_TRUE(eventually([&] { return server->statistics().moves_blocked == 3; }));
  EXPECT_EQ(last_change()[1], (Place{1, 0.5f}));

  EXPECT_EQ(server->statistics().players, 2u);
  EXPECT_EQ(server->statistics().peers, 3u);
  first.reset();
  ASSERT_TRUE(third.wait_cube(1));
  EXPECT_EQ(second.state().role.at("cube"), 2);
  third.channel().send(std::string("left"));
  ASSERT_TRUE(eventually([&] { return last_change()[0] == Place{-0.5f, 0}; }));
  EXPECT_EQ(server->statistics().peers, 2u);
}

TEST_F(RoomTest, SlowClientSkipsToTheNewestAndNobodyElseNotices) {
  start();
  Client slow(*relay, {.through_link = true}), fast(*relay);
  ASSERT_TRUE(slow.wait_open());
  ASSERT_TRUE(fast.wait_open());
  slow.link().cut = true;
  constexpr std::size_t count = 12;
  for (unsigned i = 1; i <= count; ++i) {
    server->publish({.bytes = map_bytes(200'000, i), .places = rest});
    ASSERT_TRUE(fast.wait_maps(i)) << "map " << i;
  }
  slow.link().cut = false;
  ASSERT_TRUE(slow.wait(
      [](const auto& s) { return !s.maps.empty() && s.maps.back() == as_binary(map_bytes(200'000, count)); },
      10s));
  // What SCTP's 64 KiB swallowed, the one in transit, and the newest.
  EXPECT_LE(slow.state().maps.size(), 4u);
  EXPECT_EQ(slow.state().maps[0], as_binary(map_bytes(200'000, 1))) << "a map in transit is finished";
  EXPECT_EQ(server->statistics().maps_skipped, count - slow.state().maps.size());
}

TEST_F(RoomTest, ClientThatSignalingLosesLeavesAtOnceAndItsCubeIsInherited) {
  start();
  // What a closed tab does: no word, no close, and nothing is taken any more.
  Client vanishing(*relay, {.through_link = true});
  ASSERT_TRUE(vanishing.wait_cube(1));
  Client second(*relay);
  ASSERT_TRUE(second.wait_cube(2));
  Client third(*relay);
  ASSERT_TRUE(third.wait_cube(0));
  vanishing.link().cut = true;
  const auto start = std::chrono::steady_clock::now();
  relay->send_raw(nlohmann::json{{"id", vanishing.id()}, {"type", "gone"}}.dump());
  ASSERT_TRUE(third.wait_cube(1));
  EXPECT_LT(std::chrono::steady_clock::now() - start, 1s);
  EXPECT_EQ(server->statistics().peers, 2u);
  EXPECT_EQ(server->statistics().players, 2u);
  third.channel().send(std::string("up"));
  EXPECT_TRUE(eventually([&] { return server->statistics().moves == 1; }));
}

TEST_F(RoomTest, GoneIsTheEndOfWhateverThereIs) {
  start();
  const auto gone = [&](int id) { relay->send_raw(nlohmann::json{{"id", id}, {"type", "gone"}}.dump()); };
  Client open(*relay);
  ASSERT_TRUE(open.wait_cube(1));
  gone(open.id());
  EXPECT_TRUE(open.wait([](const auto& s) { return s.closed; })) << "a client that lives is told";
  gone(open.id());
  gone(4711);

  Client joining(*relay);
  ASSERT_TRUE(joining.wait([](const auto& s) { return !s.candidates.empty(); }));
  EXPECT_EQ(server->statistics().messages_refused, 0u) << "to leave is no mistake";
  gone(joining.id());  // most likely before its channel is open
  Client last(*relay);
  ASSERT_TRUE(last.wait_cube(1));
}

TEST_F(RoomTest, WildcardsOfferTheAddressesThatOthersReach) {
  for (const auto* wildcard : {"", "0.0.0.0", "::"}) {
    auto everywhere = options();
    everywhere.bind_address = wildcard;
    server = std::make_unique<Server>(everywhere);
    wait_connected();
    Client client(*relay);
    if (!client.wait([](const auto& s) { return !s.candidates.empty(); }, 2s))
      GTEST_SKIP() << "this machine has none but loopback addresses";
    EXPECT_TRUE(client.wait_cube(1)) << "bound to '" << wildcard << "'";
    for (const std::string& candidate : client.state().candidates)
      EXPECT_THAT(candidate, testing::Not(testing::ContainsRegex(" (0\\.0\\.0\\.0|127\\.[0-9.]+|::1?) ")));
    server.reset();
    ASSERT_TRUE(eventually([&] { return !relay->connected(); }));
  }
}

TEST_F(RoomTest, Ipv6LoopbackWorks) {
  auto six = options();
  six.bind_address = "::1";
  server = std::make_unique<Server>(six);
  wait_connected();
  Client client(*relay, {.bind_address = "::1"});
  if (!client.wait([](const auto& s) { return !s.candidates.empty(); }, 2s)) GTEST_SKIP() << "no IPv6 here";
  EXPECT_TRUE(client.wait_cube(1));
}

TEST_F(RoomTest, ServerWithConnectionsEndsAtOnce) {
  start();
  Client client(*relay);
  ASSERT_TRUE(client.wait_open());
  for (unsigned i = 1; i <= 20; ++i) server->publish({.bytes = map_bytes(300'000, i), .places = rest});
  const auto start = std::chrono::steady_clock::now();
  server.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - start, 1s);
  EXPECT_TRUE(client.wait([](const auto& s) { return s.closed; })) << "the client hears of it";
}

}  // namespace
}  // namespace lichtveld::stream::test
