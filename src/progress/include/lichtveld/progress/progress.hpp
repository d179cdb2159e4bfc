// How far long work has come, for whoever shows it. Of the whole process, as log lines are: what works says so,
// and knows nothing of who looks.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace lichtveld::progress {

// While it lives this is being done, within what else is.
class Work {
 public:
  // `parts`: how many it has, of about the same length; 0 if nobody knows.
  explicit Work(std::string name, std::uint64_t parts = 0);
  ~Work();
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  // From any thread.
  void done(std::uint64_t parts = 1) { done_ += parts; }

 private:
  friend std::optional<struct State> now();
  double share(double of_part) const;

  const std::string name_;
  const std::uint64_t parts_;
  const std::chrono::steady_clock::time_point begun_;
  std::atomic<std::uint64_t> done_ = 0;
};

struct State {
  std::string name;                   // of the innermost
  std::chrono::duration<double> ago;  // that the outermost began
  // Of the outermost that knows its parts; the innermost's share of a part counts, too.
  std::optional<double> share;  // done, 0..1
  std::optional<std::chrono::duration<double>> left;
};

// Nothing if nothing long is being done.
std::optional<State> now();

}  // namespace lichtveld::progress
