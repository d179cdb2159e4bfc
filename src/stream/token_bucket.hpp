// A rate limit that lets bursts through: `burst` tokens at the start, refilled at `rate` a second.
#pragma once

#include <algorithm>
#include <chrono>

namespace lichtveld::stream {

class TokenBucket {
 public:
  using Clock = std::chrono::steady_clock;

  TokenBucket(double rate, double burst) : rate_(rate), burst_(burst), tokens_(burst) {}

  // Takes one token if there is one.
  bool take(Clock::time_point now = Clock::now()) {
    const std::chrono::duration<double> passed = now - last_;
    last_ = now;
    tokens_ = std::min(burst_, tokens_ + rate_ * std::max(0.0, passed.count()));
    if (tokens_ < 1) return false;
    tokens_ -= 1;
    return true;
  }

 private:
  double rate_, burst_, tokens_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace lichtveld::stream
