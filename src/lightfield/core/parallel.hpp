// Work that is shared out among all cores.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstdint>
#include <thread>

namespace lichtveld::lightfield {

// each(i) for first .. end - 1, `grain` of them at a time in order. No two may write to the same place.
template <typename Each>
void for_each_index(std::uint32_t first, std::uint32_t end, std::uint32_t grain, const Each& each) {
#ifdef __SANITIZE_THREAD__
  // The sanitizer does not see how TBB's own threads, which it did not compile, wait for each other.
  const std::uint32_t middle = first + (end - first) / 2;
  const auto run = [&](std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t i = from; i < to; ++i) each(i);
  };
  if (end <= first) return;
  if (end - first <= grain) return run(first, end);
  std::thread other([&] { run(middle, end); });
  run(first, middle);
  other.join();
#else
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(first, end, grain),
                    [&](const tbb::blocked_range<std::uint32_t>& some) {
                      for (std::uint32_t i = some.begin(); i < some.end(); ++i) each(i);
                    });
#endif
}

}  // namespace lichtveld::lightfield
