// Ways to a peer: ports, addresses, and what is counted of them.
#include <array>
#include <boost/asio/ip/udp.hpp>
#include <future>
#include <iterator>
#include <set>
#include <sstream>

#include "stream_room.hpp"

namespace lichtveld::stream::test {
namespace {

using nlohmann::json;

unsigned short free_udp_port() {
  boost::asio::io_context io;
  const boost::asio::ip::udp::socket probe(io, {boost::asio::ip::address_v4::loopback(), 0});
  return probe.local_endpoint().port();
}

std::set<std::string> ports_of(const Client& client) {
  std::set<std::string> ports;
  for (const std::string& line : client.state().candidates) {
    std::istringstream words(line);
    const std::vector<std::string> parts{std::istream_iterator<std::string>(words), {}};
    if (parts.size() > 5) ports.insert(parts[5]);
  }
  return ports;
}

TEST_F(RoomTest, AllClientsShareOneUdpPort) {
  auto shared = options();
  shared.udp_ports.first = shared.udp_ports.last = free_udp_port();
  server = std::make_unique<Server>(shared);
  wait_connected();
  server->publish({.bytes = map_bytes(100'000, 1), .places = rest});
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 5; ++i) clients.push_back(std::make_unique<Client>(*relay));
  for (const auto& client : clients) {
    EXPECT_TRUE(client->wait_maps(1));
    EXPECT_THAT(ports_of(*client), testing::ElementsAre(std::to_string(shared.udp_ports.first)));
  }
  clients.front().reset();
  Client late(*relay);
  EXPECT_TRUE(late.wait_maps(1)) << "the port outlives its first client";
}

TEST_F(RoomTest, PortsAreTakenFromTheRange) {
  auto ranged = options();
  ranged.udp_ports = {45'100, 45'110};
  server = std::make_unique<Server>(ranged);
  wait_connected();
  Client client(*relay);
  ASSERT_TRUE(client.wait_open());
  for (const std::string& port : ports_of(client)) {
    EXPECT_GE(std::stoi(port), 45'100);
    EXPECT_LE(std::stoi(port), 45'110);
  }
}

TEST_F(RoomTest, PublicAddressIsToldBesideOurOwn) {
  auto behind_nat = options();
  behind_nat.public_address = "203.0.113.7";
  server = std::make_unique<Server>(behind_nat);
  wait_connected();
  Client client(*relay);
  ASSERT_TRUE(client.wait_open()) << "our own address goes on to work";
  ASSERT_TRUE(client.wait([](const auto& s) { return s.candidates.size() >= 2; }));
  EXPECT_THAT(client.state().candidates, testing::Contains(testing::HasSubstr(" 203.0.113.7 ")));
  EXPECT_EQ(ports_of(client).size(), 1u) << "a 1:1 NAT keeps the port";
}

TEST_F(RoomTest, PairsAreCountedByKind) {
  start();
  Client client(*relay);
  ASSERT_TRUE(client.wait_cube(1));
  std::uint64_t pairs = 0;
  for (const auto& [kinds, count] : server->statistics().pairs) {
    EXPECT_THAT(kinds, testing::MatchesRegex("(host|prflx)_(host|prflx)"));
    pairs += count;
  }
  EXPECT_EQ(pairs, 1u);
  ASSERT_TRUE(eventually([&] { return !relay->work().is_null(); }));
  EXPECT_THAT(relay->work().at("counts").dump(), testing::HasSubstr("\"pair_"));
}

// An offer as of a client that says nothing more, but for these candidates.
void offer_and_be_silent(Relay& relay, const std::vector<std::string>& candidates) {
  rtc::PeerConnection connection;
  std::promise<std::string> made;
  connection.onLocalDescription([&](const rtc::Description& description) {
    std::string sdp(description);
    made.set_value(sdp);
  });
  const auto channel = connection.createDataChannel("lichtveld");
  const std::string sdp = made.get_future().get();
  const int id = relay.attach([](const json&) {});
  relay.send_raw(json{{"id", id}, {"type", "offer"}, {"description", sdp}}.dump());
  for (const std::string& line : candidates)
    relay.send_raw(json{{"id", id}, {"type", "candidate"}, {"candidate", line}, {"mid", "0"}}.dump());
}

TEST_F(RoomTest, FailuresAreCountedByTheirCause) {
  start();
  offer_and_be_silent(*relay, {"candidate:1 1 UDP 2122317823 abcdef.local 56143 typ host"});
  offer_and_be_silent(*relay, {"candidate:1 1 UDP 2122317823 127.0.0.1 9 typ host"});
  ASSERT_TRUE(eventually([&] { return server->statistics().connect_failures.size() == 2; }, 25s));
  EXPECT_EQ(server->statistics().connect_failures,
            (std::map<std::string, std::uint64_t>{{"no_candidates", 1}, {"no_pair", 1}}));
}

// What the library cannot use or read is left out; the rest is asked, and the room goes on.
TEST_F(RoomTest, IceServersOfTheGreetingAreUsed) {
  boost::asio::io_context io;
  boost::asio::ip::udp::socket stun(io, {boost::asio::ip::address_v4::loopback(), 0});
  const std::string port = std::to_string(stun.local_endpoint().port());
  start();
  const json servers{{{"urls", {"stun:127.0.0.1:" + port, "nonsense", "turns:127.0.0.1:1"}}},
                     {{"urls", "no list"}},
                     {{"urls", {std::string(300, 'x')}}},
                     7};
  relay->send_raw(json{{"type", "welcome"}, {"id", "server"}, {"iceServers", servers}}.dump());
  offer_and_be_silent(*relay, {});  // where a pair is found at once, no more servers are asked
  std::array<char, 1500> packet{};
  boost::asio::ip::udp::endpoint from;
  stun.non_blocking(true);
  EXPECT_TRUE(eventually([&] {
    boost::system::error_code error;
    const std::size_t size = stun.receive_from(boost::asio::buffer(packet), from, 0, error);
    return !error && size >= 20 && packet[0] == 0 && packet[1] == 1;  // a binding request (RFC 8489)
  }));
}

TEST_F(RoomTest, BadPortsAndAddressesAreRefused) {
  for (const UdpPorts ports : {UdpPorts{0, 1}, UdpPorts{2, 1}}) {
    auto bad = options();
    bad.udp_ports = ports;
    EXPECT_THROW(Server{bad}, std::invalid_argument);
  }
  auto bad = options();
  bad.public_address = "room.example.org";
  EXPECT_THROW(Server{bad}, std::invalid_argument);
}

}  // namespace
}  // namespace lichtveld::stream::test
