// SIGINT and SIGTERM as a call.
#pragma once

#include <csignal>
#include <functional>
#include <thread>

namespace lichtveld::commands {

// While it lives, the first SIGINT or SIGTERM calls `stop` on a thread of its own. Make it before any other
// thread, so that all of them inherit the blocked signals.
class StopSignals {
 public:
  explicit StopSignals(std::function<void()> stop) {
    sigemptyset(&signals_);
    for (const int signal : {SIGINT, SIGTERM}) sigaddset(&signals_, signal);
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
    waiter_ = std::thread([this, stop = std::move(stop)] {
      int signal = 0;
      sigwait(&signals_, &signal);
      stop();
    });
  }

  ~StopSignals() {
    pthread_kill(waiter_.native_handle(), SIGTERM);  // harmless when it has ended: the thread is not joined yet
    waiter_.join();
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  sigset_t signals_, before_;
  std::thread waiter_;
};

}  // namespace lichtveld::commands
