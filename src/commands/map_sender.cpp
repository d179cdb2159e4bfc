#include "map_sender.hpp"

#include <utility>

#include "lichtveld/stream/encoder.hpp"

namespace lichtveld::commands {

MapSender::MapSender(stream::Server& server, std::uint32_t size, WorkLog& log)
    : server_(server), size_(size), log_(log), thread_([this] { run(); }) {}

MapSender::~MapSender() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
}

void MapSender::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !next_ || failure_; });
  if (failure_) std::rethrow_exception(failure_);
}

void MapSender::send(std::vector<std::uint8_t> pixels, Places places) {
  {
    const std::lock_guard lock(mutex_);
    next_ = Picture{std::move(pixels), std::move(places)};
  }
  changed_.notify_all();
}

void MapSender::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return next_ || stopped_; });
    if (stopped_) return;
    auto picture = std::exchange(next_, std::nullopt);
    changed_.notify_all();
    lock.unlock();
    std::exception_ptr failure;
    try {
      auto png = log_.time("encode", [&] { return stream::encode_png(picture->pixels, size_); });
      server_.publish(std::move(png), std::move(picture->places));
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    failure_ = failure;
    changed_.notify_all();
    if (failure) return;
  }
}

}  // namespace lichtveld::commands
