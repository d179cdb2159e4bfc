// A client as a browser is one, with the real WebRTC library.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <rtc/rtc.hpp>
#include <string>
#include <vector>

#include "stream_relay.hpp"

namespace lichtveld::stream::test {

class Client {
 public:
  struct Options {
    std::string label = "lichtveld";
    std::string protocol = "";
    rtc::Reliability reliability = {};
    bool through_link = false;  // all that it sends and gets goes through link()
    std::string bind_address = "127.0.0.1";
    nlohmann::json offer_with = nlohmann::json::object();  // further members of the offer
    bool tells_candidates = true;
  };
  struct State {
    bool open = false, closed = false;
    std::vector<std::string> texts;  // but PNG_TRANSFER_COMPLETE
    std::vector<rtc::binary> maps;
    std::size_t texts_before_first_chunk = 0;
    nlohmann::json role;                  // the last
    std::vector<std::string> candidates;  // the server's
  };

  explicit Client(Relay& relay) : Client(relay, Options()) {}
  Client(Relay& relay, Options options);
  ~Client();

  // Whether `condition` of the state came true in time.
  template <typename Condition>
  bool wait(Condition condition, std::chrono::milliseconds time = std::chrono::seconds(5)) {
    std::unique_lock lock(inbox_->mutex);
    return inbox_->changed.wait_for(lock, time, [&] { return condition(std::as_const(inbox_->state)); });
  }
  bool wait_open() {
    return wait([](const State& s) { return s.open; });
  }
  bool wait_maps(std::size_t count, std::chrono::milliseconds time = std::chrono::seconds(5)) {
    return wait([&](const State& s) { return s.maps.size() >= count; }, time);
  }
  bool wait_cube(int cube) {
    return wait([&](const State& s) { return s.role.is_object() && s.role.at("cube") == cube; });
  }
  State state() const {
    const std::lock_guard lock(inbox_->mutex);
    return inbox_->state;
  }

  int id() const { return id_; }
  // The secret of this stay; empty before the first role.
  std::string session() const {
    const auto role = state().role;
    return role.is_object() ? role.value("session", "") : "";
  }
  rtc::DataChannel& channel() { return *channel_; }
  rtc::PeerConnection& connection() { return *connection_; }
  Link& link() { return *inbox_->link; }
  // The relay is about to end: no message goes there any more.
  void forget_relay();

 private:
  // Shared with callbacks that may still run while the client ends.
  struct Inbox {
    // An answer must not come to the library while it is still making the offer.
    std::mutex calls;
    std::mutex mutex;  // guards what follows
    std::condition_variable changed;
    State state;
    rtc::binary map;
    std::unique_ptr<Link> link;
    Relay* relay;
    int id = 0;
    void send(nlohmann::json message);
    void received(const nlohmann::json& message, rtc::PeerConnection& connection, bool through_link);
  };

  std::shared_ptr<Inbox> inbox_ = std::make_shared<Inbox>();
  int id_ = 0;
  std::shared_ptr<rtc::PeerConnection> connection_;
  std::shared_ptr<rtc::DataChannel> channel_;
};

}  // namespace lichtveld::stream::test
