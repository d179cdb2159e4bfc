#include "lichtveld/progress/progress.hpp"

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

namespace lichtveld::progress {

namespace {

std::mutex mutex;
std::vector<const Work*> running;  // outermost first

}  // namespace

Work::Work(std::string name, std::uint64_t parts)
    : name_(std::move(name)), parts_(parts), begun_(std::chrono::steady_clock::now()) {
  const std::lock_guard lock(mutex);
  running.push_back(this);
}

Work::~Work() {
  const std::lock_guard lock(mutex);
  std::erase(running, this);
}

double Work::share(double of_part) const {
  return std::min((static_cast<double>(done_) + of_part) / static_cast<double>(parts_), 1.0);
}

std::optional<State> now() {
  const std::lock_guard lock(mutex);
  if (running.empty()) return {};
  const auto time = std::chrono::steady_clock::now();
  State state{.name = running.back()->name_, .ago = time - running.front()->begun_, .share = {}, .left = {}};
  const Work* outermost = nullptr;
  for (auto work = running.rbegin(); work != running.rend(); ++work) {
    if ((*work)->parts_ == 0) continue;
    state.share = (*work)->share(state.share.value_or(0));
    outermost = *work;
  }
  if (outermost != nullptr && *state.share > 0)
    state.left = (time - outermost->begun_) * ((1 - *state.share) / *state.share);
  return state;
}

}  // namespace lichtveld::progress
