// SIGINT and SIGTERM as a call.
#pragma once

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <thread>

namespace lichtveld::commands {

// While it lives, the first SIGINT or SIGTERM calls `stop` on a thread of its own, and another one more than a
// second later ends the process at once: who asks again means it. (Within that second it is the same request,
// which a terminal or a supervisor often sends twice.) Make it before any other thread, so that all of them
// inherit the blocked signals.
class StopSignals {
 public:
  explicit StopSignals(std::function<void()> stop) {
    sigemptyset(&signals_);
    for (const int signal : {SIGINT, SIGTERM}) sigaddset(&signals_, signal);
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
    waiter_ = std::thread([this, stop = std::move(stop)] {
      int signal = 0;
      sigwait(&signals_, &signal);
      if (done_) return;
      stop();
      const auto asked = std::chrono::steady_clock::now();
      do {
        sigwait(&signals_, &signal);
        if (done_) return;
      } while (std::chrono::steady_clock::now() - asked < std::chrono::seconds(1));
      _exit(128 + signal);
    });
  }

  ~StopSignals() {
    done_ = true;
    pthread_kill(waiter_.native_handle(), SIGTERM);
    waiter_.join();
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  sigset_t signals_, before_;
  std::atomic<bool> done_ = false;
  std::thread waiter_;
};

}  // namespace lichtveld::commands
