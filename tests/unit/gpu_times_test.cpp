// Times of passes and stages.
#include <gtest/gtest.h>

#include <thread>

#include "lichtveld/gpu/times.hpp"

namespace lichtveld::gpu {
namespace {

using namespace std::chrono_literals;

// A stage's time is its own: not that of stages within, nor the waits for a device whose passes tell theirs.
TEST(Times, OfStagesAreTheirOwn) {
  TimeLedger ledger;
  const auto start = std::chrono::steady_clock::now();
  ledger.time("outer", [&] {
    std::this_thread::sleep_for(20ms);
    ledger.time("inner", [&] { std::this_thread::sleep_for(30ms); });
    std::this_thread::sleep_for(40ms);
    ledger.add_pass("pass", 25);
    ledger.waited(40ms, 25);
  });
  const std::chrono::duration<double, std::milli> all = std::chrono::steady_clock::now() - start;
  const auto& times = ledger.so_far();
  EXPECT_GE(times.host.at("inner").ms, 30);
  EXPECT_EQ(times.host.at("inner").calls, 1u);
  EXPECT_GE(times.host.at("outer").ms, 20);
  EXPECT_NEAR(times.host.at("waits").ms, 15, 1e-9);
  EXPECT_NEAR(times.host.at("outer").ms + times.host.at("inner").ms + times.host.at("waits").ms +
                  times.passes.at("pass").gpu_ms,
              all.count(), 1);
}

TEST(Times, BetweenTwoMomentsLeaveOutWhatDidNotHappen) {
  TimeLedger ledger;
  ledger.add_pass("before", 1);
  ledger.add_pass("both", 2);
  const auto earlier = ledger.so_far();
  ledger.add_pass("both", 3);
  ledger.add_pass("after", 4);
  const auto between = ledger.so_far() - earlier;
  EXPECT_FALSE(between.passes.contains("before"));
  EXPECT_EQ(between.passes.at("both").calls, 1u);
  EXPECT_NEAR(between.passes.at("both").gpu_ms, 3, 1e-9);
  EXPECT_NEAR(between.passes.at("after").gpu_ms, 4, 1e-9);
  EXPECT_TRUE(between.host.empty());
}

}  // namespace
}  // namespace lichtveld::gpu
