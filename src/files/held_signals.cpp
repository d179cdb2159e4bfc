#include "held_signals.hpp"

#include <atomic>

namespace lichtveld::files {

namespace {

std::atomic<int> noted = 0;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use nothing else");

void note(int signal) {
  noted = signal;
}

struct sigaction action_of(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  return action;
}

}  // namespace

HeldSignals::HeldSignals() {
  noted = 0;
  const auto noting = action_of(note), ignoring = action_of(SIG_IGN);
  for (std::size_t i = 0; i < held.size(); ++i) {
    sigaction(held[i], nullptr, &before_[i]);
    // What nohup ignores stays ignored, and somebody else's handler ends nothing by itself.
    if (before_[i].sa_handler == SIG_DFL) sigaction(held[i], &noting, nullptr);
  }
  // At `ulimit -f` write() then fails and says so, instead of the process ending without a word.
  sigaction(SIGXFSZ, &ignoring, &size_limit_before_);
}

HeldSignals::~HeldSignals() {
  sigaction(SIGXFSZ, &size_limit_before_, nullptr);
  for (std::size_t i = 0; i < held.size(); ++i) sigaction(held[i], &before_[i], nullptr);
  if (const int signal = noted) raise(signal);
}

bool HeldSignals::any() const {
  return noted != 0;
}

}  // namespace lichtveld::files
