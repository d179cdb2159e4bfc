// Work that is shared out among all cores.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstdint>

namespace lichtveld::lightfield {

// each(i) for first .. end - 1, `grain` of them at a time in order. No two may write to the same place.
template <typename Each>
void for_each_index(std::uint32_t first, std::uint32_t end, std::uint32_t grain, const Each& each) {
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(first, end, grain),
                    [&](const tbb::blocked_range<std::uint32_t>& some) {
                      for (std::uint32_t i = some.begin(); i < some.end(); ++i) each(i);
                    });
}

}  // namespace lichtveld::lightfield
