// Names the mutant with which a process ends: in a crash, at a sanitizer's finding, or past its time.
#pragma once

#include <pthread.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace lichtveld::mutants {

class Watchdog {
 public:
  // Of the thread that makes it, which it ends by SIGABRT where a mutant takes longer than `limit`. One at a
  // time.
  explicit Watchdog(std::chrono::seconds limit);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  void begin(const std::string& mutant);
  void end();

  // What of it is being done. Any thread may end there.
  static void doing(const char* what);

 private:
  void watch(std::chrono::seconds limit);

  std::mutex mutex_;
  std::condition_variable changed_;
  bool busy_ = false, over_ = false;
  std::size_t begun_ = 0;
  const pthread_t watched_;
  std::thread thread_;
};

}  // namespace lichtveld::mutants
