// What serve's stages have taken so far, for /metrics.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>

#include "lichtveld/gpu/frame.hpp"
#include "lichtveld/stream/server.hpp"

namespace lichtveld::commands {

// A map's way: input (a move waits for the loop), place (where the cube gets), update (its light, and reading
// it back), encode, send (stream::Server's own). Thread-safe: each stage runs on a thread of its own.
class WorkLog {
 public:
  using Duration = std::chrono::duration<double>;

  void add(const std::string& stage, Duration took) {
    const std::lock_guard lock(mutex_);
    auto& time = stages_[stage];
    ++time.runs;
    time.seconds += took.count();
  }

  // Runs it and adds what it took.
  template <typename Work>
  auto time(const std::string& stage, Work work) {
    struct Timer {
      WorkLog& log;
      const std::string& stage;
      std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
      ~Timer() { log.add(stage, std::chrono::steady_clock::now() - start); }
    } const timer{*this, stage};
    return work();
  }

  void set_passes(const gpu::PassTimes& passes) {
    const std::lock_guard lock(mutex_);
    passes_ = passes;
  }

  stream::WorkTimes times() const {
    const std::lock_guard lock(mutex_);
    stream::WorkTimes times;
    for (const auto& [name, time] : stages_) times.stages.push_back({name, time.runs, time.seconds});
    for (const auto& [name, time] : passes_) times.passes.push_back({name, time.calls, time.gpu_ms / 1000});
    return times;
  }

 private:
  struct Time {
    std::uint64_t runs = 0;
    double seconds = 0;
  };
  mutable std::mutex mutex_;
  std::map<std::string, Time> stages_;
  gpu::PassTimes passes_;
};

}  // namespace lichtveld::commands
