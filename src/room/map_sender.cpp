#include "map_sender.hpp"

#include <utility>

namespace lichtveld::room {

MapSender::MapSender(std::function<void(Map)> publish, WorkLog& log)
    : publish_(std::move(publish)), log_(log), thread_([this] { run(); }) {}

void MapSender::close() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void MapSender::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !next_ || failure_ || stopped_; });
  if (failure_) std::rethrow_exception(failure_);
}

void MapSender::send(Map map) {
  {
    const std::lock_guard lock(mutex_);
    next_ = std::move(map);
  }
  changed_.notify_all();
}

void MapSender::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return next_ || stopped_; });
    if (stopped_) return;
    auto map = std::exchange(next_, std::nullopt);
    changed_.notify_all();
    lock.unlock();
    std::exception_ptr failure;
    try {
      log_.time("encode", [&] { publish_(std::move(*map)); });
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    failure_ = failure;
    changed_.notify_all();
    if (failure) return;
  }
}

}  // namespace lichtveld::room
