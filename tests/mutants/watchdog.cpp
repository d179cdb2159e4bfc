#include "watchdog.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/common_interface_defs.h>
#endif

namespace lichtveld::mutants {
namespace {

// For handlers of signals, which may call next to nothing.
char current[512];
std::atomic<const char*> what_of_it = "";

void say(const char* text) {
  [[maybe_unused]] const auto written = write(STDERR_FILENO, text, std::strlen(text));
}

void name_mutant() {
  say("\nended with ");
  say(current);
  say(" at: ");
  say(what_of_it);
  say("\n");
}

#ifndef __SANITIZE_ADDRESS__
void on_crash(int signal) {
  name_mutant();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}
#endif

}  // namespace

Watchdog::Watchdog(std::chrono::seconds limit)
    : watched_(pthread_self()), thread_([this, limit] { watch(limit); }) {
#ifdef __SANITIZE_ADDRESS__
  __sanitizer_set_death_callback(&name_mutant);
#else
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(signal, &on_crash);
#endif
}

Watchdog::~Watchdog() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Watchdog::begin(const std::string& mutant) {
  const std::lock_guard lock(mutex_);
  std::strncpy(current, mutant.c_str(), sizeof current - 1);
  busy_ = true;
  ++begun_;
  changed_.notify_all();
}

void Watchdog::end() {
  const std::lock_guard lock(mutex_);
  busy_ = false;
  changed_.notify_all();
}

void Watchdog::doing(const char* what) {
  what_of_it = what;
}

void Watchdog::watch(std::chrono::seconds limit) {
  std::unique_lock lock(mutex_);
  while (!over_) {
    changed_.wait(lock, [&] { return busy_ || over_; });
    const auto one = begun_;
    if (changed_.wait_for(lock, limit, [&] { return over_ || !busy_ || begun_ != one; })) continue;
    say("past its time, ");
    name_mutant();
    pthread_kill(watched_, SIGABRT);  // sanitizers show where that thread is
    return;
  }
}

}  // namespace lichtveld::mutants
