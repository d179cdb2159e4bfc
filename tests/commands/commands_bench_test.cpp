// lichtveld bench: its tables and charts, small.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "commands_run.hpp"
#include "scene_builder.hpp"

namespace lichtveld::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using Line = std::map<std::string, std::string>;  // cells by column

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream in(line + ",");
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

std::string header_of(const fs::path& file) {
  std::ifstream in(file);
  std::string header;
  std::getline(in, header);
  return header;
}

std::vector<Line> table(const fs::path& file) {
  std::ifstream in(file);
  std::string text;
  std::getline(in, text);
  const auto columns = cells_of(text);
  std::vector<Line> lines;
  while (std::getline(in, text)) {
    const auto cells = cells_of(text);
    EXPECT_EQ(cells.size(), columns.size()) << text;
    Line line;
    for (std::size_t i = 0; i < std::min(cells.size(), columns.size()); ++i) line[columns[i]] = cells[i];
    lines.push_back(line);
  }
  return lines;
}

double number(const Line& line, const std::string& column) {
  return std::stod(line.at(column));
}

class Bench : public ::testing::Test {
 protected:
  Ran bench(const std::string& arguments) {
    return run("bench --out " + out().string() + " --reference-cache " + cache().string() + " " + arguments, "",
               300);
  }
  fs::path out() const { return folder_.path() / "out"; }
  fs::path cache() const { return folder_.path() / "references"; }

  void expect_passes();
  void expect_chart();
  void expect_more_work_to_come_nearer();
  void expect_updates();
  void expect_pictures();

 private:
  TempFolder folder_;
};

// One run, for all that its tables and charts must be: it takes longer than reading them.
TEST_F(Bench, WritesTablesAndCharts) {
  const auto ran = bench("--validation --scene " + cornell +
                         " --size 32 --psf 24,96 --repeats 1 --spp 256 --path-spp 1,4 --updates 3");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("compare-and-swap beats bitonic"));
  EXPECT_THAT(ran.output, HasSubstr("sorting and multisampled emission dominate"));
  EXPECT_THAT(ran.output, HasSubstr("the reference's own noise"));
  expect_passes();
  expect_chart();
  expect_more_work_to_come_nearer();
  expect_updates();
  expect_pictures();
}

void Bench::expect_passes() {
  EXPECT_EQ(header_of(out() / "passes.csv"),
            "scene,method,abuffer,sort,size,psf,bounces,pass,calls,ms_median,ms_a_call");
  EXPECT_EQ(table(out() / "passes.csv").size(), 2u * 3 * 2 * 6);  // A-buffers, sorts, counts of PSFs, passes
}

void Bench::expect_chart() {
  EXPECT_EQ(
      header_of(out() / "chart.csv"),
      "scene,method,abuffer,sort,size,psf,bounces,ms_median,ms_min,rel_rmse,rel_p99,rel_max,bias,psf_size,"
      "weights,error_estimate,spp");
  std::map<std::string, int> counts;
  for (const auto& line : table(out() / "chart.csv")) {
    ++counts[line.at("method") + " " + line.at("weights")];
    EXPECT_EQ(line.at("scene"), "cornell");
    EXPECT_GT(number(line, "ms_min"), 0);
    EXPECT_GE(number(line, "ms_median"), number(line, "ms_min"));
    EXPECT_GT(number(line, "rel_rmse"), 0.01);
    EXPECT_GT(number(line, "rel_max"), number(line, "rel_p99"));
    EXPECT_GT(number(line, "rel_max"), number(line, "rel_rmse"));
    EXPECT_LT(std::abs(number(line, "bias")), number(line, "rel_rmse"));
    EXPECT_EQ(line.at("spp").empty(), line.at("method") != "reference");
  }
  // 2 A-buffers * 3 sorts * 2 counts; the last A-buffer again at 2 sizes of PSFs and 2 kinds of weights.
  EXPECT_EQ(counts, (std::map<std::string, int>{{"thesis solid-angle", 12 + 2},
                                                {"thesis equal", 2},
                                                {"links solid-angle", 2},
                                                {"rays solid-angle", 2},
                                                {"reference ", 2}}));
}

void Bench::expect_more_work_to_come_nearer() {
  std::map<std::string, double> errors;
  for (const auto& line : table(out() / "chart.csv")) {
    if (line.at("method") == "reference")
      errors["spp " + line.at("spp")] = number(line, "rel_rmse");
    else if (line.at("psf_size") == "32")
      errors[line.at("abuffer") + " " + line.at("psf") + " " + line.at("weights")] = number(line, "rel_rmse");
  }
  EXPECT_LT(errors.at("list 96 solid-angle"), errors.at("list 24 solid-angle"));
  EXPECT_LT(errors.at("stencil 96 solid-angle"), errors.at("stencil 24 solid-angle"));
  EXPECT_GE(errors.at("list 96 equal"), 0.97 * errors.at("list 96 solid-angle"));
  EXPECT_NEAR(errors.at("spp 4") / errors.at("spp 1"), 0.5, 0.15) << "noise halves with four times the paths";
}

void Bench::expect_updates() {
  EXPECT_EQ(header_of(out() / "updates.csv"),
            "method,size,psf,ms_p50,ms_p95,speedup_vs_thesis,rel_rmse,scene,steps,rel_rmse_moving");
  const auto lines = table(out() / "updates.csv");
  ASSERT_EQ(lines.size(), 6u);  // counts of PSFs, methods
  constexpr std::array methods = {"thesis", "links", "rays"};
  for (std::size_t row = 0; row < lines.size(); ++row) {
    const auto& line = lines[row];
    EXPECT_EQ(line.at("method"), methods[row % 3]);
    if (row % 3 == 0) {
      EXPECT_EQ(number(line, "speedup_vs_thesis"), 1);
    }
    EXPECT_GE(number(line, "ms_p95"), number(line, "ms_p50"));
  }
  EXPECT_EQ(header_of(out() / "choices.csv"), "scene,size,psf,choice,ms_p50,ms_p95,rel_rmse,rel_rmse_moving");
  const auto choices = table(out() / "choices.csv");
  ASSERT_EQ(choices.size(), 10u);  // counts of PSFs, choices
  EXPECT_EQ(choices[0].at("choice"), "default");
  EXPECT_EQ(choices[1].at("choice"), "--step-bounces 0.25");
  for (std::size_t method = 0; method < 2; ++method)
    EXPECT_LT(number(lines[3 + method], "rel_rmse"), number(lines[method], "rel_rmse")) << methods[method];
}

void Bench::expect_pictures() {
  for (const auto* name : {"chart.svg", "chart.png", "error_vs_psf.svg", "error_vs_psf.png", "passes.svg",
                           "passes.png", "error_maps_cornell.png"}) {
    ASSERT_TRUE(fs::exists(out() / name)) << name;
    EXPECT_GT(fs::file_size(out() / name), 4000u) << name;
  }
  for (const auto& entry : fs::directory_iterator(out()))
    EXPECT_NE(entry.path().filename().string().front(), '.') << "left behind: " << entry.path();
}

TEST_F(Bench, AReferenceIsTracedOnceAndADamagedOneAnew) {
  const std::string tiny =
      "--scene " + cornell +
      " --size 16 --psf 8 --repeats 1 --bounces 1 --spp 4 --path-spp 0 --updates 0 --abuffer list"
      " --weights solid-angle --psf-size 1x";
  EXPECT_THAT(bench(tiny).output, AllOf(HasSubstr("tracing the reference"), Not(HasSubstr("is known"))));
  const auto error = table(out() / "chart.csv").at(0).at("rel_rmse");
  EXPECT_THAT(bench(tiny).output, AllOf(HasSubstr("is known"), Not(HasSubstr("tracing the reference"))));
  EXPECT_EQ(table(out() / "chart.csv").at(0).at("rel_rmse"), error);

  const auto file = fs::directory_iterator(cache())->path();
  {
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(fs::file_size(file)) / 2);
    bytes << "spoiled";
  }
  for (int damage = 0; damage < 3; ++damage) {
    if (damage == 1) fs::resize_file(file, fs::file_size(file) - 1);
    if (damage == 2) std::ofstream(file) << "lichtveld reference of something else\n";
    const auto again = bench(tiny);
    EXPECT_EQ(again.status, 0) << again.output;
    EXPECT_THAT(again.output, AllOf(HasSubstr("damaged"), HasSubstr("tracing the reference"))) << damage;
    EXPECT_EQ(table(out() / "chart.csv").at(0).at("rel_rmse"), error) << damage;
    EXPECT_THAT(bench(tiny).output, HasSubstr("is known")) << damage;
  }
}

TEST_F(Bench, ScaleTellsWhatTrianglesAndCoresCost) {
  const auto ran = bench("--scale --size 32");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("1000000 triangles"));
  EXPECT_EQ(header_of(out() / "scale.csv"),
            "triangles,cores,load_ms,first_ms,cube_step_ms,ball_step_ms,resident_mib");
  const auto lines = table(out() / "scale.csv");
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.size() % 4, 0u) << "rooms, each on one core and on all";
  EXPECT_EQ(lines.front().at("triangles"), "1000");
  EXPECT_EQ(lines.back().at("triangles"), "1000000");
  for (const auto& line : lines)
    for (const char* time : {"load_ms", "first_ms", "cube_step_ms", "ball_step_ms"})
      EXPECT_GT(number(line, time), 0);
}

TEST_F(Bench, LampsOfAnySizeAreComparedByEveryMethod) {
  const auto ran = bench("--lamps --size 32 --spp 64 --repeats 1");
  ASSERT_EQ(ran.status, 0) << ran.output;
  const auto lines = table(out() / "lamps.csv");
  ASSERT_EQ(lines.size(), 7u * 3) << "rooms, each by thesis, links and rays";
  EXPECT_EQ(lines.front().at("scene"), "lamp_100_percent");
  EXPECT_EQ(lines.back().at("scene"), "lamp_0.01_percent");
  for (const auto& line : lines)
    if (line.at("method") != "thesis") {
      EXPECT_LT(number(line, "rel_rmse"), 0.1) << line.at("scene");
    }
  EXPECT_THAT(bench("--lamps --scale").output, HasSubstr("--scale"));
}

TEST(BenchOddities, ADarkRoomWithoutBodiesAndWithoutGnuplotIsTimedAlone) {
  const TempFolder folder;
  SceneBuilder builder;
  builder.box("room", glm::vec3(-1), glm::vec3(1), {0, 0, 1, 1}, builder.material(glm::vec3(0.5)), true);
  const auto dark = folder.write("dark.glb", builder.glb()).string();
  fs::create_directory(folder.path() / "bin");
  for (const auto* tool : {"timeout", "sh"})
    fs::create_symlink(std::string("/usr/bin/") + tool, folder.path() / "bin" / tool);
  const auto out = (folder.path() / "out").string();
  const auto ran = run("bench --scene " + dark + " --out " + out + " --reference-cache " + out +
                           "/cache --size 16 --psf 8 --repeats 1 --updates 2",
                       "PATH=" + (folder.path() / "bin").string());
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_THAT(ran.output, AllOf(HasSubstr("nothing glows"), HasSubstr("no node has extras.movable"),
                                HasSubstr("gnuplot-nox")));
  for (const auto& line : table(fs::path(out) / "chart.csv")) {
    EXPECT_EQ(line.at("rel_rmse"), "");
    EXPECT_GT(number(line, "ms_median"), 0);
  }
  EXPECT_FALSE(fs::exists(fs::path(out) / "updates.csv"));
  EXPECT_FALSE(fs::exists(fs::path(out) / "passes.png"));
}

}  // namespace
}  // namespace lichtveld::testing
