// The end of a room's pipeline: maps are published on a thread of its own while the next one is computed.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "lichtveld/room/room.hpp"
#include "work_log.hpp"

namespace lichtveld::room {

class MapSender {
 public:
  // The log must outlive it.
  MapSender(std::function<void(Map)> publish, WorkLog& log);
  ~MapSender() { close(); }
  MapSender(const MapSender&) = delete;
  MapSender& operator=(const MapSender&) = delete;

  // Returns once the one before has been begun: input that is taken before then would only grow old in line.
  // Throws what publishing the one before has thrown.
  void wait();

  // Returns at once.
  void send(Map map);

  // Drops a map that has not been begun, and returns when the one under way has gone.
  void close();

 private:
  void run();

  const std::function<void(Map)> publish_;
  WorkLog& log_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::optional<Map> next_;
  bool stopped_ = false;
  std::exception_ptr failure_;
  std::jthread thread_;  // last: it uses the rest
};

}  // namespace lichtveld::room
