// What others tell the room's loop: the newest places, and that it is time to end.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "lichtveld/room/places.hpp"

namespace lichtveld::room {

// Holds one value, the newest: a loop that was busy renders where things are now. Thread-safe.
class PlaceInbox {
 public:
  using Clock = std::chrono::steady_clock;
  struct News {
    Places places;
    Clock::time_point came;
  };

  void put(Places places) {
    const std::lock_guard lock(mutex_);
    newest_ = News{std::move(places), Clock::now()};
    changed_.notify_one();
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

  // The newest places, once; empty when none came in time or when stopped.
  std::optional<News> take(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, patience, [&] { return newest_ || stopped_; });
    if (stopped_) return std::nullopt;
    return std::exchange(newest_, std::nullopt);
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<News> newest_;
  bool stopped_ = false;
};

}  // namespace lichtveld::room
