// What a room's work has taken so far.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lichtveld::room {

struct Work {
  struct Time {
    std::string name;
    std::uint64_t runs = 0;
    double seconds = 0;  // summed over the runs
  };
  struct Count {
    std::string name;
    std::uint64_t value = 0;
  };
  // The stages of a map's way, and the passes of one of them.
  std::vector<Time> stages, passes;
  std::vector<Count> counts;
};

}  // namespace lichtveld::room
