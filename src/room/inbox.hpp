// What others tell the room's loop: the newest places and lights, and that it is time to end.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "lichtveld/room/places.hpp"

namespace lichtveld::room {

// Holds the newest of each alone: a loop that was busy renders where things are now. Thread-safe.
class Inbox {
 public:
  using Clock = std::chrono::steady_clock;
  struct News {
    std::optional<Places> places = {};
    std::optional<scene::Scales> scales = {};
    Clock::time_point came = Clock::now();  // the newest
  };

  void place(Places places) {
    put([&](News& news) { news.places = std::move(places); });
  }
  void dim(scene::Scales scales) {
    put([&](News& news) { news.scales = std::move(scales); });
  }

  void stop() {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    changed_.notify_one();
  }

  bool stopped() const {
    const std::lock_guard lock(mutex_);
    return stopped_;
  }

  // Whether take() would return at once.
  bool has_news() const {
    const std::lock_guard lock(mutex_);
    return newest_ || stopped_;
  }

  // What is new, once; empty when none came in time or when stopped.
  std::optional<News> take(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, patience, [&] { return newest_ || stopped_; });
    if (stopped_) return std::nullopt;
    return std::exchange(newest_, std::nullopt);
  }

 private:
  template <typename Change>
  void put(const Change& change) {
    const std::lock_guard lock(mutex_);
    if (!newest_) newest_.emplace();
    change(*newest_);
    newest_->came = Clock::now();
    changed_.notify_one();
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<News> newest_;
  bool stopped_ = false;
};

}  // namespace lichtveld::room
