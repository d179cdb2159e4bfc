// Runs the executable and keeps what it said.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace lichtveld::testing {

struct Ran {
  int status;          // the exit status, or 128 + the signal that ended it
  std::string output;  // stdout and stderr
};

// `environment` is put before the command, as in a shell: "NAME=value ".
// It is ended after so many seconds.
inline Ran run(const std::string& arguments, const std::string& environment = "", int seconds = 60) {
  const std::string command =
      environment + " timeout " + std::to_string(seconds) + " " LICHTVELD_BINARY " " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot run " + command);
  Ran ran;
  std::array<char, 4096> piece;
  while (const std::size_t read = fread(piece.data(), 1, piece.size(), pipe))
    ran.output.append(piece.data(), read);
  const int status = pclose(pipe);
  ran.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return ran;
}

inline const std::string cornell = LICHTVELD_SOURCE_DIR "/assets/cornell.glb";

}  // namespace lichtveld::testing
