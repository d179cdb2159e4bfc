// Who comes back, and many who go at once.
#include "stream_room.hpp"

namespace lichtveld::stream::test {
namespace {

using nlohmann::json;

void say_gone(Relay& relay, const Client& client) {
  relay.send_raw(json{{"id", client.id()}, {"type", "gone"}}.dump());
}

TEST_F(RoomTest, PlayerWhoComesBackHasItsCubeAgain) {
  start();
  Client first(*relay), second(*relay);
  ASSERT_TRUE(first.wait_open() && second.wait_open());
  ASSERT_TRUE(eventually([&] { return !first.session().empty() && !second.session().empty(); }));
  Client heir(*relay);
  ASSERT_TRUE(heir.wait_cube(0));
  const auto cube = first.state().role.at("cube").get<int>();
  say_gone(*relay, first);
  ASSERT_TRUE(heir.wait_cube(cube));
  Client again(*relay, {.offer_with = {{"session", first.session()}}});
  ASSERT_TRUE(again.wait_cube(cube));
  EXPECT_TRUE(heir.wait_cube(0)) << "the heir is told";
  EXPECT_NE(again.session(), first.session());
  EXPECT_EQ(server->statistics().claims_refused, 0u);
}

TEST_F(RoomTest, PlayerWhoseOldWayIsStillThereTakesItsOwnPlace) {
  start();
  Client lost(*relay, {.through_link = true});
  ASSERT_TRUE(lost.wait_cube(1));
  Client watcher(*relay), other(*relay);
  ASSERT_TRUE(watcher.wait_open() && other.wait_open());
  lost.link().cut = true;
  Client again(*relay, {.offer_with = {{"session", lost.session()}}});
  ASSERT_TRUE(again.wait_cube(1));
  EXPECT_TRUE(eventually([&] { return server->statistics().peers == 3; })) << "the old one goes";
  again.channel().send(std::string("up"));
  EXPECT_TRUE(eventually([&] { return server->statistics().moves == 1; }));
}

TEST_F(RoomTest, ClaimsOfStrangersAreRefusedAndCounted) {
  start();
  Client first(*relay);
  ASSERT_TRUE(first.wait_cube(1));
  Client second(*relay);
  ASSERT_TRUE(second.wait_cube(2));
  Client thief(*relay, {.offer_with = {{"session", std::string(36, 'a')}}});
  ASSERT_TRUE(thief.wait_cube(0));
  EXPECT_EQ(server->statistics().claims_refused, 1u);
  Client oversized(*relay, {.offer_with = {{"session", std::string(65, 'a')}}});
  EXPECT_TRUE(oversized.wait_cube(0)) << "what cannot be a secret is none";
  relay->send_raw(json{{"id", thief.id()}, {"type", "rejoin"}, {"session", "nobody's"}}.dump());
  EXPECT_TRUE(eventually([&] { return server->statistics().claims_refused == 2; }));
  relay->send_raw(json{{"id", thief.id()}, {"type", "rejoin"}, {"session", second.session()}}.dump());
  EXPECT_TRUE(eventually([&] { return server->statistics().claims_refused == 3; }))
      << "who has a stay cannot speak for another";
  EXPECT_EQ(first.state().role.at("cube"), 1);
  EXPECT_EQ(second.state().role.at("cube"), 2);
}

TEST_F(RoomTest, ClientsWithAWatchersTicketNeverGetACube) {
  start();
  Client watcher(*relay, {.offer_with = {{"seat", "watcher"}, {"name", "Ada"}}});
  ASSERT_TRUE(watcher.wait_cube(0));
  Client player(*relay);
  ASSERT_TRUE(player.wait_cube(1));
  say_gone(*relay, player);
  ASSERT_TRUE(watcher.wait([](const auto& s) { return s.role.at("players") == 0; }));
  EXPECT_EQ(watcher.state().role.at("cube"), 0);
}

TEST_F(RoomTest, AfterANewRelayThoseWhoSpeakUpAreToldTheirRoleAnew) {
  start();
  Client first(*relay);
  ASSERT_TRUE(first.wait_cube(1));
  const unsigned short port = relay->port();
  first.forget_relay();
  relay.reset();
  ASSERT_TRUE(eventually([&] { return !server->statistics().signaling_connected; }));
  relay = std::make_unique<Relay>(port);
  wait_connected();
  std::mutex mutex;
  json role;
  const int id = relay->attach([&](const json& message) {
    const std::lock_guard lock(mutex);
    role = message;
  });
  relay->send_raw(json{{"id", id}, {"type", "rejoin"}, {"session", first.session()}}.dump());
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return role.is_object() && role.at("cube") == 1 && role.at("session") == first.session();
  }));
  relay->send_raw(json{{"id", id}, {"type", "gone"}}.dump());
  EXPECT_TRUE(eventually([&] { return server->statistics().peers == 0; })) << "it is present by its new id";
  relay->detach(id);
}

// Half of a full room, both players among them.
TEST_F(RoomTest, WhenManyGoAtOnceTheRestKnowsItsRolesAndSignalingStays) {
  start();
  constexpr std::size_t all = 60, dying = 30;
  std::vector<std::unique_ptr<Client>> clients;
  for (std::size_t i = 0; i < all; ++i) {
    // Seldom a handshake between two ends in one process fails in the WebRTC library; pages try again, too.
    bool joined = false;
    for (int attempt = 0; attempt < 3 && !joined; ++attempt) {
      if (attempt > 0) say_gone(*relay, *clients.back()), clients.pop_back();
      clients.push_back(std::make_unique<Client>(*relay));
      joined = clients.back()->wait([](const auto& s) { return s.role.is_object(); }, 5s);
    }
    ASSERT_TRUE(joined) << i;
  }
  const int upgrades = relay->upgrades;
  for (std::size_t i = 0; i < dying; ++i) say_gone(*relay, *clients[i]);
  for (std::size_t i = dying; i < all; ++i)
    EXPECT_TRUE(clients[i]->wait(
        [&](const auto& s) { return s.role.at("players") == 2 && s.role.at("watchers") == all - dying - 2; },
        2s))
        << i << " was told " << clients[i]->state().role;
  EXPECT_EQ(clients[dying]->state().role.at("cube"), 1);
  EXPECT_EQ(clients[dying + 1]->state().role.at("cube"), 2);
  for (std::size_t i = dying; i < all; ++i) say_gone(*relay, *clients[i]);
  EXPECT_TRUE(eventually([&] { return server->statistics().peers == 0; }, 2s));
  EXPECT_EQ(relay->upgrades, upgrades) << "signaling was kept";
  EXPECT_TRUE(server->statistics().signaling_connected);
}

}  // namespace
}  // namespace lichtveld::stream::test
