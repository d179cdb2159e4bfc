// What work has taken: passes on the device, stages of the host's own.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace lichtveld::gpu {

struct PassTime {
  std::uint64_t calls = 0;
  double gpu_ms = 0;  // summed over the calls
};
using PassTimes = std::map<std::string, PassTime>;

struct StageTime {
  std::uint64_t calls = 0;
  double ms = 0;  // summed over the calls: of the stage itself, without stages within and waits for the device
};
using StageTimes = std::map<std::string, StageTime>;

// Where nothing overlaps they add up to the wall clock's time.
struct Times {
  PassTimes passes;
  StageTimes host;
};

// What came between. Names of which nothing came are left out.
Times operator-(const Times& later, const Times& earlier);

// Adds it all up. For one thread.
class TimeLedger {
 public:
  // While it lives, the host's time counts for this stage. Stages end in the reverse order of their beginnings.
  class Stage {
   public:
    Stage(TimeLedger& ledger, std::string name);
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

   private:
    TimeLedger& ledger_;
    std::string name_;
  };

  // Runs it as such a stage.
  template <typename Work>
  auto time(const char* name, const Work& work) {
    const Stage stage(*this, name);
    return work();
  }

  void add_pass(const std::string& name, double gpu_ms);
  // The host has waited so long for the device, whose passes took `gpu_ms` of it; what is more, for a device
  // that was slow to begin and to answer, is the stage `waits`.
  void waited(std::chrono::duration<double, std::milli> time, double gpu_ms);

  const Times& so_far() const { return times_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Running {
    Clock::time_point begun;
    std::chrono::duration<double, std::milli> others{};  // stages within, and waits
  };

  Times times_;
  std::vector<Running> running_;  // innermost last
};

}  // namespace lichtveld::gpu
