#include "core/memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace lichtveld::lightfield {

namespace {

constexpr std::uint64_t unknown = std::numeric_limits<std::uint64_t>::max();

// A number of a file, after a word of it if one is given.
std::uint64_t number_in(const char* file, const std::string& word = "") {
  std::ifstream in(file);
  for (std::string before; !word.empty() && before != word && in >> before;) {
  }
  std::uint64_t value = 0;
  return in >> value ? value : unknown;  // a limit may read "max"
}

std::uint64_t difference(std::uint64_t limit, std::uint64_t used) {
  if (limit == unknown || used == unknown) return unknown;
  return limit > used ? limit - used : 0;
}

}  // namespace

std::uint64_t free_memory() {
  const auto kibibytes = number_in("/proc/meminfo", "MemAvailable:");
  std::uint64_t bytes = kibibytes == unknown ? unknown : kibibytes << 10;
  bytes = std::min(
      bytes, difference(number_in("/sys/fs/cgroup/memory.max"), number_in("/sys/fs/cgroup/memory.current")));
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY) {
    const auto pages = number_in("/proc/self/statm");
    const auto used = pages == unknown ? 0 : pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    bytes = std::min(bytes, difference(space.rlim_cur, used));
  }
  return bytes;
}

void require_memory(const std::string& what, std::uint64_t bytes, std::uint64_t limit,
                    const std::string& instead) {
  const auto free = limit > 0 ? limit : free_memory();
  const auto most = limit > 0 ? limit : free / 4 * 3;
  if (bytes <= most) return;
  throw std::runtime_error(
      what + " take " + std::to_string(bytes >> 20) + " MiB, and " + std::to_string(most >> 20) + " MiB are " +
      (limit > 0 ? "what --memory allows" : "three quarters of what is free") + "; " + instead);
}

}  // namespace lichtveld::lightfield
