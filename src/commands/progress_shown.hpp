// What the process is at, on stderr.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

namespace lichtveld::commands {

// While it lives, progress::now() is shown once it has taken two seconds: as a bar on a terminal, elsewhere as
// a line every five seconds.
class ProgressShown {
 public:
  ProgressShown();
  ~ProgressShown();
  ProgressShown(const ProgressShown&) = delete;
  ProgressShown& operator=(const ProgressShown&) = delete;

 private:
  void show();

  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread shower_;
};

}  // namespace lichtveld::commands
