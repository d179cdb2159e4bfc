// What one peer is still to be sent, paced by how fast it takes it.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <rtc/datachannel.hpp>
#include <string>
#include <utility>
#include <vector>

#include "lichtveld/stream/map.hpp"

namespace lichtveld::stream {

// One map, shared by all who get it.
struct Map {
  MapFormat format;
  std::vector<std::uint8_t> bytes;
  std::string places;  // as sent (protocol.hpp); empty without cubes
};

struct SentCounts {
  std::uint64_t maps = 0, skipped = 0, bytes = 0;
  std::chrono::duration<double> sending{};  // of the maps, each from offer() on
};

// Sends only while the channel's queue is empty, so that at most one chunk or text waits there: a
// map in transit is finished, and the one after it is the newest of that moment. (SCTP's own send buffer, 64
// KiB, lies beyond that queue and cannot be seen from here.)
class Outbox {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Outbox(std::shared_ptr<rtc::DataChannel> channel) : channel_(std::move(channel)) {}

  // The newest map; one that waits already is skipped.
  void offer(std::shared_ptr<const Map> map);

  // Says again which places the peer's map shows (`otherwise` before its first map), at the next chance; calls
  // before that chance come to one message, so nothing piles up for a peer that takes nothing.
  void repeat_places(const std::string& otherwise);

  // At the next chance; of several that wait the last counts.
  void tell_lights(std::string lights) { due_lights_ = std::move(lights); }

  // Sends what the channel takes now; to be called again when it has drained. Throws what the channel throws
  // when it has closed.
  void pump();

  // When the channel's queue was last seen empty. A full one that stays full is a peer that takes nothing.
  Clock::time_point last_empty() const { return last_empty_; }

  // Counts since the last call.
  SentCounts take_counts() { return std::exchange(counts_, {}); }

 private:
  void send_text(const std::string& text);
  void send_map_part();

  std::shared_ptr<rtc::DataChannel> channel_;
  std::shared_ptr<const Map> newest_, current_;  // waiting; in transit
  Clock::time_point newest_came_, current_came_;
  std::size_t offset_ = 0;   // bytes of current_ that are sent
  std::string due_, shown_;  // places
  std::string due_lights_;
  bool shows_map_ = false;
  Clock::time_point last_empty_ = Clock::now();
  SentCounts counts_;
};

}  // namespace lichtveld::stream
