#include "progress_shown.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <string>

#include "lichtveld/progress/progress.hpp"

namespace lichtveld::commands {

namespace {

using std::chrono_literals::operator""ms, std::chrono_literals::operator""s;

constexpr auto shown_after = 2s, between_lines = 5s;
constexpr auto between_bars = 200ms;
constexpr int cells = 30;
constexpr auto clear_to_end_of_line = "\033[K";

std::string left_of(const progress::State& state) {
  if (!state.left) return "";
  const auto seconds = static_cast<long>(std::ceil(state.left->count()));
  return seconds < 120 ? fmt::format(", about {} s left", seconds)
                       : fmt::format(", about {} min left", (seconds + 59) / 60);
}

std::string line_of(const progress::State& state) {
  if (!state.share) return fmt::format("{} for {:.0f} s", state.name, state.ago.count());
  return fmt::format("{}, {:.0f} %{}", state.name, 100 * *state.share, left_of(state));
}

// Whatever is written next is written over it.
void draw_bar(const progress::State& state) {
  const int full = static_cast<int>(cells * state.share.value_or(0));
  const std::string bar = std::string(full, '#') + std::string(cells - full, '.');
  fmt::print(stderr, "[{}] {}{}\r", bar, line_of(state), clear_to_end_of_line);
  std::fflush(stderr);
}

}  // namespace

ProgressShown::ProgressShown() {
  // Signals are for the other threads.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  shower_ = std::thread([this] { show(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

ProgressShown::~ProgressShown() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  ended_.notify_one();
  shower_.join();
}

void ProgressShown::show() {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  bool drawn = false;
  auto last = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, between_bars, [&] { return end_; })) {
    const auto state = progress::now();
    if (state && state->ago > shown_after && terminal) {
      draw_bar(*state);
      drawn = true;
    } else if (std::exchange(drawn, false)) {
      fmt::print(stderr, "{}", clear_to_end_of_line);
    } else if (const auto time = std::chrono::steady_clock::now();
               state && state->ago > between_lines && time - last >= between_lines) {
      spdlog::info("{}", line_of(*state));
      last = time;
    }
  }
  if (drawn) fmt::print(stderr, "{}", clear_to_end_of_line);
}

}  // namespace lichtveld::commands
