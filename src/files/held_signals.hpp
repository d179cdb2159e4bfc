// Signals that end the process, put off while something half done lies about.
#pragma once

#include <array>
#include <csignal>

namespace lichtveld::files {

// While it lives, SIGHUP, SIGINT, SIGQUIT and SIGTERM are only noted, whichever thread gets them; afterwards
// the process gets the last of them after all. A handler that removed the file itself could run on one thread
// while another is about to make that file. One at a time in a process.
class HeldSignals {
 public:
  HeldSignals();
  ~HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

  // Whether one waits: whoever asked does not want to wait for long.
  bool any() const;

 private:
  static constexpr std::array held = {SIGHUP, SIGINT, SIGQUIT, SIGTERM};
  std::array<struct sigaction, held.size()> before_;
  struct sigaction size_limit_before_;
};

}  // namespace lichtveld::files
