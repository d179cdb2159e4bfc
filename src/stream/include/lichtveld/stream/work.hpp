// What a render server's work has taken since the start; signaling shows it in /metrics.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lichtveld::stream {

struct WorkTime {
  std::string name;  // lower-case letters and underscores, up to 32
  std::uint64_t runs = 0;
  double seconds = 0;  // summed over the runs
  bool operator==(const WorkTime&) const = default;
};

// The same of things that are only counted.
struct WorkCount {
  std::string name;  // as in WorkTime
  std::uint64_t value = 0;
  bool operator==(const WorkCount&) const = default;
};

// Of the stages that a map goes through, and of the passes of one of them.
struct Work {
  std::vector<WorkTime> stages, passes;
  std::vector<WorkCount> counts;
  bool operator==(const Work&) const = default;
};

}  // namespace lichtveld::stream
