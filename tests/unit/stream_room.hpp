// A relay, and a server with two cubes in its room.
#pragma once

#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <thread>

#include "lichtveld/stream/server.hpp"
#include "stream_client.hpp"

namespace lichtveld::stream::test {

using namespace std::chrono_literals;

inline std::vector<std::uint8_t> map_bytes(std::size_t size, unsigned seed) {
  std::minstd_rand random(seed);
  std::vector<std::uint8_t> bytes(size);
  for (auto& value : bytes) value = static_cast<std::uint8_t>(random());
  return bytes;
}

inline rtc::binary as_binary(const std::vector<std::uint8_t>& bytes) {
  const auto* data = reinterpret_cast<const rtc::byte*>(bytes.data());
  return {data, data + bytes.size()};
}

// Whether `condition` came true in time.
template <typename Condition>
bool eventually(Condition condition, std::chrono::milliseconds time = 5s) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

class RoomTest : public testing::Test {
 protected:
  ServerOptions options() const {
    ServerOptions options;
    options.signaling = relay->url();
    options.token = Relay::token;
    options.scene_hash = std::string(64, 'a');
    options.bind_address = "127.0.0.1";
    options.places = rest;
    // Quarters of a metre, within one metre of the middle.
    options.mover = [](std::size_t cube, const std::vector<Place>& places, Move move) {
      Place place = places[cube];
      (move == Move::left || move == Move::right ? place.x : place.y) +=
          move == Move::right || move == Move::up ? 0.25f : -0.25f;
      return std::abs(place.x) > 1 || std::abs(place.y) > 1 ? places[cube] : place;
    };
    options.places_changed = [this](const std::vector<Place>& places) {
      const std::lock_guard lock(mutex);
      changed = places;
    };
    return options;
  }
  void start() {
    server = std::make_unique<Server>(options());
    wait_connected();
  }
  void wait_connected() {
    ASSERT_TRUE(eventually([&] { return relay->connected() && server->statistics().signaling_connected; }));
  }
  std::vector<Place> last_change() const {
    const std::lock_guard lock(mutex);
    return changed;
  }
  bool refused_at_least(std::uint64_t count) {
    return eventually([&] { return server->statistics().messages_refused >= count; });
  }

  const std::vector<Place> rest{{-0.5f, 0}, {0.5f, 0.25f}};
  static constexpr auto rest_text = "-0.5!0/0.5!0.25";
  mutable std::mutex mutex;
  mutable std::vector<Place> changed;
  std::unique_ptr<Relay> relay = std::make_unique<Relay>();
  std::unique_ptr<Server> server;  // ends before the relay
};

}  // namespace lichtveld::stream::test
