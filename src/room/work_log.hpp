// What a room's stages have taken so far.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>

#include "lichtveld/gpu/times.hpp"
#include "lichtveld/room/work.hpp"

namespace lichtveld::room {

// A map's way: input (a move waits for the loop), place (where the body gets), update (its light, and reading
// it back), encode (what is published). Thread-safe: stages run on several threads.
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

  // The light field's own: passes on the device, and stages on the host.
  void set_times(const gpu::Times& times) {
    const std::lock_guard lock(mutex_);
    passes_ = times.passes;
    for (const auto& [name, time] : times.host) {
      passes_[name].calls += time.calls;
      passes_[name].gpu_ms += time.ms;
    }
  }

  void count(const std::string& what, std::uint64_t many) {
    const std::lock_guard lock(mutex_);
    counts_[what] += many;
  }

  Work work() const {
    const std::lock_guard lock(mutex_);
    Work work;
    for (const auto& [name, time] : stages_) work.stages.push_back({name, time.runs, time.seconds});
    for (const auto& [name, time] : passes_) work.passes.push_back({name, time.calls, time.gpu_ms / 1000});
    for (const auto& [name, value] : counts_) work.counts.push_back({name, value});
    return work;
  }

 private:
  struct Time {
    std::uint64_t runs = 0;
    double seconds = 0;
  };
  mutable std::mutex mutex_;
  std::map<std::string, Time> stages_;
  gpu::PassTimes passes_;
  std::map<std::string, std::uint64_t> counts_;
};

}  // namespace lichtveld::room
