// Output files: whole or not at all, whatever lies in their place and whoever ends the process.
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "lichtveld/files/output.hpp"

namespace lichtveld::files {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class Output : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_ / "sub"); }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string read(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }
  static mode_t mode(const fs::path& file) {
    struct stat status {};
    EXPECT_EQ(stat(file.c_str(), &status), 0) << file;
    return status.st_mode & 0777;
  }
  template <typename Do>
  static void expect_refused(const Do& act, const testing::Matcher<std::string>& says) {
    try {
      act();
      ADD_FAILURE() << "nothing was thrown";
    } catch (const OutputError& error) {
      EXPECT_THAT(std::string(error.what()), says);
    }
  }
  std::ptrdiff_t files_there() const {
    const fs::directory_iterator files(folder_);
    return std::distance(begin(files), end(files)) - 1;  // sub
  }

  const fs::path folder_ = fs::temp_directory_path() / ("lichtveld-output-" + std::to_string(getpid()));
  const fs::path file_ = folder_ / "r.json";
};

TEST_F(Output, ANewFileFollowsTheUmaskAndAnOldOneKeepsItsPermissions) {
  const mode_t before = umask(027);
  write_text(file_, "new");
  EXPECT_EQ(mode(file_), 0640u);
  ASSERT_EQ(chmod(file_.c_str(), 0604), 0);
  write_text(file_, "newer");
  umask(before);
  EXPECT_EQ(mode(file_), 0604u);
  EXPECT_EQ(read(file_), "newer");
  EXPECT_EQ(files_there(), 1);
}

TEST_F(Output, LinksStayAndTheirTargetIsWritten) {
  fs::create_symlink("sub/chain", file_);
  fs::create_symlink(folder_ / "target", folder_ / "sub" / "chain");
  for (const auto* text : {"into a dangling link", "into an old file"}) {
    write_text(file_, text);
    EXPECT_TRUE(fs::is_symlink(file_) && fs::is_symlink(folder_ / "sub" / "chain"));
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder_ / "target")));
    EXPECT_EQ(read(folder_ / "target"), text);
  }
}

TEST_F(Output, LinksInACircleAreRefused) {
  fs::create_symlink("r.json", folder_ / "there");
  fs::create_symlink("there", file_);
  expect_refused([&] { check_place(file_); }, AllOf(HasSubstr(file_.string()), HasSubstr("circle")));
  expect_refused([&] { target_of(file_); }, HasSubstr("circle"));
}

TEST_F(Output, ADanglingLinkIntoNoFolderIsRefused) {
  fs::create_symlink("nowhere/r.json", file_);
  expect_refused([&] { check_place(file_); }, AllOf(HasSubstr("nowhere"), HasSubstr("not a folder")));
}

TEST_F(Output, DevicesAreWrittenInto) {
  check_place("/dev/null");
  write_text("/dev/null", "gone");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  fs::create_symlink("/dev/null", file_);
  write_text(file_, "gone");
  EXPECT_TRUE(fs::is_character_file("/dev/null") && fs::is_symlink(file_));
}

TEST_F(Output, APipesReaderGetsAllOfIt) {
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  const std::string sent(300'000, 'x');  // several times what a pipe holds
  std::string got;
  std::thread reader([&] { got = read(file_); });
  write_text(file_, sent);
  reader.join();
  EXPECT_TRUE(got == sent);
  EXPECT_TRUE(fs::is_fifo(file_));
}

TEST_F(Output, LongNamesAreRefusedBeforeAnyWork) {
  for (const auto& name : {folder_ / std::string(300, 'x'), folder_ / std::string(300, 'x') / "r.json",
                           fs::path(std::string(5000, '/') + "r.json")})
    expect_refused([&] { check_place(name); }, AllOf(HasSubstr("too long"), HasSubstr("shorter")));
  expect_refused([&] { make_folder(folder_ / std::string(300, 'x')); }, HasSubstr("cannot be made a folder"));
  const auto longest = folder_ / std::string(255, 'x');
  check_place(longest);
  write_text(longest, "as long as can be");
  EXPECT_EQ(read(longest), "as long as can be");
}

TEST_F(Output, OneFileUnderTwoNamesIsRefused) {
  fs::create_symlink("r.json", folder_ / "link");
  fs::create_directory_symlink("sub", folder_ / "way");
  check_distinct({{"--out", file_}, {"--png", folder_ / "sub" / "r.json"}});
  for (const auto& other : {folder_ / "." / "r.json", folder_ / "sub" / ".." / "r.json", folder_ / "link"})
    expect_refused(
        [&] {
          check_distinct({{"--out", file_}, {"--report", other}});
        },
        AllOf(HasSubstr("--out"), HasSubstr("--report " + other.string()), HasSubstr("same file")));
  expect_refused(
      [&] {
        check_distinct({{"--out", folder_ / "sub" / "a"}, {"--png", folder_ / "way" / "a"}});
      },
      HasSubstr("same file"));
}

// The child writes without pause, so that most signals come while it does.
TEST_F(Output, ASignalLeavesNoHalfOfAFile) {
  const std::vector<std::uint8_t> bytes(4u << 20, 'x');
  for (int round = 0; round < 10; ++round)
    for (const int signal : {SIGHUP, SIGINT, SIGTERM}) {
      const pid_t child = fork();
      ASSERT_GE(child, 0);
      if (child == 0) {
        std::signal(signal, SIG_DFL);  // nohup's tests end as well
        while (true) write_bytes(file_, bytes);
      }
      while (!fs::exists(file_)) usleep(100);
      usleep(static_cast<useconds_t>(round) * 300);
      kill(child, signal);
      int status = 0;
      ASSERT_EQ(waitpid(child, &status, 0), child);
      EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
      EXPECT_EQ(files_there(), 1) << "a hidden file is left behind";
      EXPECT_EQ(fs::file_size(file_), bytes.size());
      fs::remove(file_);
    }
}

}  // namespace
}  // namespace lichtveld::files
