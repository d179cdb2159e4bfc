// What a stranger sends, and what signaling does to us.
#include <future>

#include "stream_room.hpp"

namespace lichtveld::stream::test {
namespace {

TEST_F(RoomTest, GarbageIsCountedAndItsSenderDroppedInTheEnd) {
  start();
  Client good(*relay);
  ASSERT_TRUE(good.wait_cube(1));
  Client bad(*relay);
  ASSERT_TRUE(bad.wait_cube(2));
  bad.channel().send(std::string("jump"));
  bad.channel().send(std::string());
  bad.channel().send(rtc::binary(5));
  bad.channel().send(rtc::binary(60'000));
  bad.channel().send(std::string(65, 'u'));
  bad.channel().send(std::string(60'000, 'u'));
  bad.channel().send(std::string("up\0", 3));
  ASSERT_TRUE(refused_at_least(7));
  EXPECT_EQ(server->statistics().messages_refused, 7u);
  EXPECT_EQ(server->statistics().moves, 0u);
  EXPECT_EQ(server->statistics().peers, 2u);

  // The server may end the channel between a look at it and a send, which then throws.
  try {
    for (int i = 0; i < 40 && bad.channel().isOpen(); ++i) bad.channel().send(rtc::binary(1));
  } catch (const std::runtime_error&) {
  }
  EXPECT_TRUE(eventually([&] { return server->statistics().peers == 1; }));
  EXPECT_TRUE(bad.wait([](const auto& s) { return s.closed; }));
  good.channel().send(std::string("up"));
  EXPECT_TRUE(eventually([&] { return server->statistics().moves == 1; }));
}

TEST_F(RoomTest, FloodOfMovesIsLimitedAndHarmsNobody) {
  start();
  Client flooding(*relay);
  ASSERT_TRUE(flooding.wait_cube(1));
  Client good(*relay);
  ASSERT_TRUE(good.wait_cube(2));
  const auto start = std::chrono::steady_clock::now();
  constexpr std::uint64_t sent = 3000;
  for (std::uint64_t i = 0; i < sent; ++i) flooding.channel().send(std::string(i % 2 ? "left" : "right"));
  server->publish({.bytes = map_bytes(100'000, 1), .places = rest});
  EXPECT_TRUE(good.wait_maps(1)) << "others go on";
  const auto total = [&] {
    const auto s = server->statistics();
    return s.moves + s.moves_blocked + s.messages_refused;
  };
  ASSERT_TRUE(eventually([&] { return total() == sent; })) << "each is counted: " << total();
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  EXPECT_LE(server->statistics().moves, 30 + 60 * passed.count() + 1);
  EXPECT_GE(server->statistics().moves, 30u);
  EXPECT_EQ(server->statistics().peers, 2u) << "a held key is no attack";
}

TEST_F(RoomTest, OtherChannelsAreClosed) {
  start();
  rtc::Reliability lossy;
  lossy.maxRetransmits = 0;
  rtc::Reliability unordered;
  unordered.unordered = true;
  Client label(*relay, {.label = "chat"}), protocol(*relay, {.protocol = "lichtveld.v99"}),
      loses(*relay, {.reliability = lossy}), reorders(*relay, {.reliability = unordered});
  for (Client* client : {&label, &protocol, &loses, &reorders})
    EXPECT_TRUE(client->wait([](const auto& s) { return s.closed; }));
  EXPECT_TRUE(refused_at_least(4));
  EXPECT_EQ(server->statistics().peers, 0u);

  Client good(*relay);
  ASSERT_TRUE(good.wait_cube(1));
  const auto second = good.connection().createDataChannel("lichtveld");
  EXPECT_TRUE(eventually([&] { return second->isClosed(); })) << "one channel a client";
  good.channel().send(std::string("up"));
  EXPECT_TRUE(eventually([&] { return server->statistics().moves == 1; })) << "the first one lives";
}

TEST_F(RoomTest, HostileSignalingIsCountedAndIgnored) {
  start();
  using nlohmann::json;
  const std::string sdp = "v=0\r\no=- 1 1 IN IP4 127.0.0.1\r\ns=-\r\nt=0 0\r\n";
  const std::vector<std::string> messages{
      "",
      "hello",
      "[]",
      "7",
      "{}",
      std::string(20'000, '['),
      std::string(200'000, 'x'),
      R"({"id":1})",
      R"({"type":"offer"})",
      R"({"id":1,"type":"dance"})",
      R"({"id":{},"type":"offer","description":"v=0"})",
      R"({"id":1.5,"type":"offer","description":"v=0"})",
      R"({"id":1,"type":"offer","description":7})",
      R"({"id":1,"type":"offer","description":""})",
      R"({"id":1,"type":"offer","description":"no sdp"})",
      json{{"id", 1}, {"type", "offer"}, {"description", sdp}}.dump(),
      json{
          {"id", 1}, {"type", "offer"}, {"description", sdp + "m=audio 9 UDP/TLS/RTP/SAVPF 111\r\na=mid:0\r\n"}}
          .dump(),
      json{{"id", 1}, {"type", "offer"}, {"description", std::string(17'000, 'a')}}.dump(),
      json{{"id", std::string(200, 'i')}, {"type", "offer"}, {"description", sdp}}.dump(),
      R"({"id":99,"type":"candidate","candidate":"candidate:1 1 UDP 1 127.0.0.1 9 typ host","mid":"0"})",
      R"({"id":1,"type":"candidate","candidate":"x"})",
  };
  for (const auto& message : messages) relay->send_raw(message);
  EXPECT_TRUE(refused_at_least(messages.size()));
  EXPECT_EQ(server->statistics().messages_refused, messages.size());

  Client client(*relay);
  ASSERT_TRUE(client.wait_cube(1)) << "and the room goes on";
  const auto refused = server->statistics().messages_refused;
  for (const auto* line : {"nonsense", "candidate:", "candidate:1 1 UDP x y z typ host"})
    relay->send_raw(json{{"id", client.id()}, {"type", "candidate"}, {"candidate", line}, {"mid", "0"}}.dump());
  // Names and empty ends are left out without complaint.
  for (const auto* line :
       {"", "candidate:1 1 UDP 1 some.name.invalid 9 typ host", "candidate:1 1 TCP 1 127.0.0.1 9 typ host"})
    relay->send_raw(json{{"id", client.id()}, {"type", "candidate"}, {"candidate", line}, {"mid", "0"}}.dump());
  for (int i = 0; i < 100; ++i)
    relay->send_raw(json{
        {"id", client.id()},
        {"type", "candidate"},
        {"candidate", "candidate:1 1 UDP " + std::to_string(i + 1) + " 127.0.0.1 9 typ host"},
        {"mid", "0"}}.dump());
  EXPECT_TRUE(refused_at_least(refused + 36)) << "too many candidates";
  client.channel().send(std::string("up"));
  EXPECT_TRUE(eventually([&] { return server->statistics().moves == 1; }));
}

TEST_F(RoomTest, FloodOfOffersIsLimited) {
  start();
  Client good(*relay);
  ASSERT_TRUE(good.wait_cube(1));
  rtc::Configuration config;
  config.bindAddress = "127.0.0.1";
  rtc::PeerConnection template_connection(config);
  std::promise<std::string> made;
  template_connection.onLocalDescription([&](const rtc::Description& d) { made.set_value(std::string(d)); });
  const auto channel = template_connection.createDataChannel("lichtveld");
  const std::string offer = made.get_future().get();
  for (int i = 0; i < 100; ++i)
    relay->send_raw(nlohmann::json{{"id", 1000 + i}, {"type", "offer"}, {"description", offer}}.dump());
  EXPECT_TRUE(refused_at_least(20));
  good.channel().send(std::string("up"));
  EXPECT_TRUE(eventually([&] { return server->statistics().moves == 1; }));
  template_connection.resetCallbacks();
}

TEST_F(RoomTest, SessionsGoOnWhileSignalingIsAway) {
  start();
  Client client(*relay);
  ASSERT_TRUE(client.wait_cube(1));
  const auto port = relay->port();
  client.forget_relay();
  relay.reset();
  ASSERT_TRUE(eventually([&] { return !server->statistics().signaling_connected; }));
  server->publish({.bytes = map_bytes(50'000, 1), .places = rest});
  EXPECT_TRUE(client.wait_maps(1));
  client.channel().send(std::string("up"));
  EXPECT_TRUE(eventually([&] { return server->statistics().moves == 1; }));

  relay = std::make_unique<Relay>(port);
  wait_connected();
  Client second(*relay);  // its id is the first one's of before
  EXPECT_TRUE(second.wait_cube(2));
  EXPECT_TRUE(client.channel().isOpen());
  EXPECT_EQ(server->statistics().peers, 2u);
  EXPECT_EQ(server->refused(), "");
}

TEST_F(RoomTest, SilentSignalingIsGivenUp) {
  start();
  Client client(*relay);
  ASSERT_TRUE(client.wait_cube(1));
  std::promise<void> thaw;
  relay->freeze(thaw.get_future().share());
  EXPECT_TRUE(eventually([&] { return !server->statistics().signaling_connected; }, 12s));
  client.channel().send(std::string("up"));
  EXPECT_TRUE(eventually([&] { return server->statistics().moves == 1; })) << "nobody else notices";
  thaw.set_value();
  wait_connected();
}

TEST_F(RoomTest, WrongTokenEndsTheTries) {
  auto wrong = options();
  wrong.token = "guessed";
  server = std::make_unique<Server>(wrong);
  ASSERT_TRUE(eventually([&] { return !server->refused().empty(); }));
  EXPECT_THAT(server->refused(), testing::AllOf(testing::HasSubstr("token"), testing::HasSubstr("401"),
                                                testing::HasSubstr(relay->url())));
  std::this_thread::sleep_for(1200ms);
  EXPECT_EQ(relay->upgrades, 1);
  EXPECT_FALSE(server->statistics().signaling_connected);
}

TEST_F(RoomTest, TakenRoomIsTriedAgain) {
  relay->conflicts = 1;
  start();
  EXPECT_EQ(server->refused(), "");
  EXPECT_EQ(relay->upgrades, 2);
}

TEST_F(RoomTest, NoSignalingAtAllIsNoError) {
  const auto port = relay->port();
  auto early = options();
  relay.reset();
  server = std::make_unique<Server>(early);
  server->publish({.bytes = map_bytes(10, 1), .places = rest});
  std::this_thread::sleep_for(100ms);
  relay = std::make_unique<Relay>(port);
  EXPECT_TRUE(eventually([&] { return server->statistics().signaling_connected; }));
}

TEST_F(RoomTest, SenselessOptionsAreNamed) {
  const auto rejected = [&](auto change) {
    auto bad = options();
    change(bad);
    try {
      const Server made(bad);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  using testing::HasSubstr;
  for (const auto* url :
       {"", "http://127.0.0.1/server", "ws://", "ws:///server", "ws://host:0/", "ws://host:99999/",
        "ws://host:abc/", "ws://ho st/", "ws://[::1/", "ws://host/a\r\nHost: b"})
    EXPECT_THAT(rejected([&](auto& o) { o.signaling = url; }), HasSubstr("ws://")) << url;
  EXPECT_THAT(rejected([](auto& o) { o.token = ""; }), HasSubstr("token"));
  EXPECT_THAT(rejected([](auto& o) { o.token = "a\r\nb"; }), HasSubstr("token"));
  EXPECT_THAT(rejected([](auto& o) { o.scene_hash = "abc"; }), HasSubstr("hash"));
  EXPECT_THAT(rejected([](auto& o) { o.bind_address = "nowhere"; }), HasSubstr("nowhere"));
  EXPECT_THAT(rejected([](auto& o) { o.mover = nullptr; }), HasSubstr("mover"));
  start();
  EXPECT_THROW(server->publish({.bytes = {}, .places = rest}), std::invalid_argument);
  EXPECT_THROW(server->publish({.bytes = {1}, .places = {{NAN, 0}}}), std::invalid_argument);
}

}  // namespace
}  // namespace lichtveld::stream::test
