#include "lichtveld/gpu/times.hpp"

#include <algorithm>
#include <utility>

namespace lichtveld::gpu {

Times operator-(const Times& later, const Times& earlier) {
  Times between;
  for (const auto& [name, time] : later.passes) {
    const auto before = earlier.passes.find(name);
    const PassTime then = before == earlier.passes.end() ? PassTime{} : before->second;
    if (time.calls > then.calls) between.passes[name] = {time.calls - then.calls, time.gpu_ms - then.gpu_ms};
  }
  for (const auto& [name, time] : later.host) {
    const auto before = earlier.host.find(name);
    const StageTime then = before == earlier.host.end() ? StageTime{} : before->second;
    if (time.calls > then.calls) between.host[name] = {time.calls - then.calls, time.ms - then.ms};
  }
  return between;
}

TimeLedger::Stage::Stage(TimeLedger& ledger, std::string name) : ledger_(ledger), name_(std::move(name)) {
  ledger_.running_.push_back({Clock::now()});
}

TimeLedger::Stage::~Stage() {
  const auto [begun, others] = ledger_.running_.back();
  ledger_.running_.pop_back();
  const std::chrono::duration<double, std::milli> all = Clock::now() - begun;
  auto& time = ledger_.times_.host[name_];
  ++time.calls;
  time.ms += (all - others).count();
  if (!ledger_.running_.empty()) ledger_.running_.back().others += all;
}

void TimeLedger::add_pass(const std::string& name, double gpu_ms) {
  auto& time = times_.passes[name];
  ++time.calls;
  time.gpu_ms += gpu_ms;
}

void TimeLedger::waited(std::chrono::duration<double, std::milli> time, double gpu_ms) {
  if (!running_.empty()) running_.back().others += time;
  auto& waits = times_.host["waits"];
  ++waits.calls;
  waits.ms += std::max(0.0, time.count() - gpu_ms);
}

}  // namespace lichtveld::gpu
