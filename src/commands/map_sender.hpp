// The end of serve's pipeline: maps are encoded and sent on a thread of its own while the next one is computed.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "lichtveld/stream/server.hpp"
#include "work_log.hpp"

namespace lichtveld::commands {

class MapSender {
 public:
  using Places = std::vector<stream::Place>;

  // Both must outlive it. Maps of size * size texels.
  MapSender(stream::Server& server, std::uint32_t size, WorkLog& log);
  ~MapSender();  // drops a map that has not been begun
  MapSender(const MapSender&) = delete;
  MapSender& operator=(const MapSender&) = delete;

  // Returns once the one before has been begun: input that is taken before then would only grow old in line.
  // Throws what encoding the one before has thrown.
  void wait();

  // sRGB RGBA pixels, and the places that they show. Returns at once.
  void send(std::vector<std::uint8_t> pixels, Places places);

 private:
  struct Picture {
    std::vector<std::uint8_t> pixels;
    Places places;
  };
  void run();

  stream::Server& server_;
  const std::uint32_t size_;
  WorkLog& log_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::optional<Picture> next_;
  bool stopped_ = false;
  std::exception_ptr failure_;
  std::jthread thread_;  // last: it uses the rest
};

}  // namespace lichtveld::commands
