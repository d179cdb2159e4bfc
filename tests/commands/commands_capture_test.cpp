// lichtveld --capture: RenderDoc finds the passes by name and in order, and where it cannot, the message says
// why.
#include <gmock/gmock.h>

#include "commands_run.hpp"
#include "scene_builder.hpp"

namespace lichtveld::testing {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

class Capture : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      names.push_back(entry.path().filename().string());
    return names;
  }

  static Ran passes(const std::string& arguments) {
    return shell("/usr/bin/python3 " LICHTVELD_SOURCE_DIR "/tools/capture_passes.py " + arguments + " 2>&1");
  }

  Ran bake(const std::string& options, const std::string& environment = "") const {
    return run("bake " + cornell + " --out " + path("E.exr") + " --size 32 --psf 8 --bounces 2 " + options,
               environment, 120);
  }

  TempFolder folder_;
};

class CaptureWithRenderDoc : public Capture {
 protected:
  void SetUp() override {
    if (shell("/usr/bin/python3 -c 'import renderdoc' 2>&1").status != 0)
      GTEST_SKIP() << "no Python module renderdoc: install python3-renderdoc, where there is such a package";
  }

  // The labels of what such a bake captures.
  std::string labels(const std::string& options) {
    const auto ran = bake(options + " --capture " + path("c.rdc"));
    EXPECT_EQ(ran.status, 0) << ran.output;
    EXPECT_THAT(ran.output, HasSubstr(path("c.rdc")));
    EXPECT_THAT(files(), UnorderedElementsAre("E.exr", "c.rdc")) << "and nothing else";
    const auto listed = passes(path("c.rdc"));
    EXPECT_EQ(listed.status, 0) << listed.output;
    const auto unnamed = passes(path("c.rdc") + " --unnamed");
    EXPECT_EQ(unnamed.status, 0) << unnamed.output;
    EXPECT_THAT(unnamed.output, IsEmpty()) << "Vulkan objects without a name";
    return listed.output;
  }
};

// The first of `lines` that is not there after the one before it, or nothing.
std::string first_missing(const std::string& text, const std::vector<std::string>& lines) {
  std::size_t at = 0;
  for (const auto& line : lines) {
    const auto found = ("\n" + text).find("\n" + line + "\n", at);
    if (found == std::string::npos) return line;
    at = found + 1;
  }
  return {};
}

TEST_F(CaptureWithRenderDoc, ThesisShowsThePassesOfAlgorithm1) {
  const auto listed = labels("--method thesis");
  std::vector<std::string> wanted = {"thesis", "  set up", "    geometry_texture x 2", "    brdf"};
  for (const char* bounce : {"  bounce 1", "  bounce 2"})
    wanted.insert(wanted.end(), {bounce, "    directions 0..7", "      8 times"});
  EXPECT_EQ(first_missing(listed, wanted), "") << listed;
  // In each bounce, of each direction, and then of all.
  const auto bounce = listed.substr(std::min(listed.find("  bounce 2"), listed.size()));
  EXPECT_THAT(bounce, ContainsRegex("        emit_radiance x [0-9]+\n        stencil_routing\n        blend\n"
                                    "    blend\n    brdf\n"));
  EXPECT_EQ(first_missing(bounce, {"  present", "    geometry_texture", "    tone_map x 4"}), "") << listed;
}

TEST_F(CaptureWithRenderDoc, LinksShowsItsSteps) {
  const auto listed = labels("--method links");
  EXPECT_EQ(first_missing(listed, {"links",
                                   "  place",
                                   "    geometry_texture x 2",
                                   "  find links",
                                   "    pairs of directions 0..3",
                                   "      receivers",
                                   "      emit_links x 2",
                                   "      emit_links_count",
                                   "      route_links",
                                   "      route_doubts",
                                   "      route_rest",
                                   "  start",
                                   "    gather x 2",
                                   "    link_bounce",
                                   "    link_change",
                                   "  bounce 2",
                                   "    all directions",
                                   "      gather",
                                   "      link_bounce",
                                   "      link_change",
                                   "  present",
                                   "    brdf",
                                   "    link_cover",
                                   "    geometry_texture",
                                   "    tone_map x 4"}),
            "")
      << listed;
}

TEST_F(CaptureWithRenderDoc, LiveShowsTheLastMove) {
  const std::string moves = "--live --move cube1=0.1,0,0 --move cube2=0.1,0,0 ";
  // By the directions, direct light is summed anew after a move; at rest it has come with the links.
  const std::string by_psf = moves + "--direct psf ";
  EXPECT_EQ(first_missing(labels(by_psf), {"links", "  place", "  find links", "  direct light", "  start"}),
            "");
  EXPECT_THAT(labels(by_psf + "--capture-after 0"), Not(HasSubstr("direct light")));
  EXPECT_THAT(labels(moves), Not(HasSubstr("direct light"))) << "exact light comes from the CPU";
}

// As with every output, a link stays one.
TEST_F(CaptureWithRenderDoc, ALinksTargetIsWritten) {
  std::filesystem::create_symlink("real.rdc", path("c.rdc"));
  const auto ran = bake("--capture " + path("c.rdc"));
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_TRUE(std::filesystem::is_symlink(path("c.rdc")));
  EXPECT_EQ(passes(path("real.rdc")).status, 0);
  EXPECT_THAT(files(), UnorderedElementsAre("E.exr", "c.rdc", "real.rdc"));
}

// RenderDoc itself takes such a capture for a good one.
TEST_F(CaptureWithRenderDoc, OnAFullDiskLeavesNothing) {
  const auto ran = bake("--capture " + path("c.rdc"), "trap '' XFSZ; ulimit -f 20;");
  EXPECT_EQ(ran.status, 1) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("c.rdc cannot be written"));
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Capture, WithoutRenderDocItSaysWhatToInstall) {
  const auto ran = bake("--capture " + path("c.rdc"), "LICHTVELD_RENDERDOC=/nonexistent/librenderdoc.so");
  EXPECT_EQ(ran.status, 1) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("librenderdoc"));
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Capture, AnotherLibraryIsNotTakenForRenderDoc) {
  const auto ran = bake("--capture " + path("c.rdc"), "LICHTVELD_RENDERDOC=libc.so.6");
  EXPECT_EQ(ran.status, 1) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("librenderdoc"));
  EXPECT_THAT(files(), IsEmpty());
}

}  // namespace
}  // namespace lichtveld::testing
