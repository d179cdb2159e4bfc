// Runs the executable and keeps what it said.
#pragma once

#include <sys/wait.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace lichtveld::testing {

struct Ran {
  int status;          // the exit status, or 128 + the signal that ended it
  std::string output;  // stdout and stderr
  double seconds = 0;  // how long it took
};

inline Ran shell(const std::string& script) {
  const auto start = std::chrono::steady_clock::now();
  FILE* pipe = popen(script.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot run " + script);
  Ran ran{};
  std::array<char, 4096> piece;
  while (const std::size_t read = fread(piece.data(), 1, piece.size(), pipe))
    ran.output.append(piece.data(), read);
  const int status = pclose(pipe);
  ran.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  ran.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return ran;
}

// Runs the executable; it is ended after so many seconds. `environment` is put before the command, as in a
// shell: "NAME=value ".
inline Ran run(const std::string& arguments, const std::string& environment = "", int seconds = 60) {
  return shell(environment + " timeout " + std::to_string(seconds) + " " LICHTVELD_BINARY " " + arguments +
               " 2>&1");
}

inline const std::string cornell = LICHTVELD_SOURCE_DIR "/assets/cornell.glb";

}  // namespace lichtveld::testing
