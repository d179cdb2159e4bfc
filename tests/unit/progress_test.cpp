// What long work says of itself.
#include "lichtveld/progress/progress.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace lichtveld::progress {
namespace {

TEST(Progress, NothingIsDoneWhereNothingWorks) {
  EXPECT_FALSE(now());
  { const Work work("bake"); }
  EXPECT_FALSE(now());
}

TEST(Progress, TheInnermostGivesTheNameAndTheOutermostTheShare) {
  const Work bake("bake");
  EXPECT_EQ(now()->name, "bake");
  EXPECT_FALSE(now()->share);
  EXPECT_FALSE(now()->left);
  Work trials("trials", 4);
  EXPECT_EQ(now()->share, 0);
  EXPECT_FALSE(now()->left) << "nothing tells how long a part takes";
  trials.done();
  EXPECT_EQ(now()->share, 0.25);
  {
    Work links("links", 10);
    links.done(5);
    EXPECT_EQ(now()->name, "links");
    EXPECT_EQ(now()->share, 0.375);
    EXPECT_GT(now()->left->count(), 0);
    links.done(500);
    EXPECT_EQ(now()->share, 0.5) << "a part is never more than one";
  }
  EXPECT_EQ(now()->name, "trials");
  EXPECT_EQ(now()->share, 0.25);
}

TEST(Progress, PartsMayBeDoneByManyThreadsWhileOthersLook) {
  Work work("paths", 4000);
  std::vector<std::jthread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      for (int part = 0; part < 1000; ++part) work.done();
    });
  threads.emplace_back([] {
    double last = 0;
    for (int look = 0; look < 1000; ++look) {
      const Work other("another's");
      const double share = *now()->share;
      EXPECT_GE(share, last);
      last = share;
    }
  });
  threads.clear();
  EXPECT_EQ(now()->share, 1);
}

}  // namespace
}  // namespace lichtveld::progress
