// lichtveld bench: its table, small.
#include <gmock/gmock.h>

#include <fstream>

#include "commands_run.hpp"
#include "scene_builder.hpp"

namespace lichtveld::testing {
namespace {

using ::testing::HasSubstr;

TEST(Bench, WritesEveryPassOfEveryRow) {
  const TempFolder folder;
  const auto ran =
      run("bench --validation --scene " + cornell + " --sizes 32 --psfs 8,24 --repeats 1 --bounces 1 --out " +
          (folder.path() / "out").string());
  ASSERT_EQ(ran.status, 0) << ran.output;
  std::ifstream csv(folder.path() / "out/passes.csv");
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "scene,method,abuffer,sort,size,psf,bounces,pass,calls,ms_median,ms_a_call");
  int lines = 0;
  while (std::getline(csv, line)) {
    EXPECT_THAT(line, HasSubstr("cornell,thesis,"));
    ++lines;
  }
  EXPECT_EQ(lines, 2 * 3 * 2 * 6);  // A-buffers, sorts, counts of PSFs, passes
  EXPECT_THAT(ran.output, HasSubstr("compare-and-swap beats bitonic"));
  EXPECT_THAT(ran.output, HasSubstr("sorting and multisampled emission dominate"));
}

}  // namespace
}  // namespace lichtveld::testing
