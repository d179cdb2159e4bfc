// Pictures against goldens. goldens.json lists each with its tolerance and the reason for it, and the driver
// that drew them. The actual pictures, and on failure the difference, are kept in
// build/<preset>/golden-pictures.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "lichtveld/gpu/device.hpp"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path folder = fs::path(LICHTVELD_SOURCE_DIR) / "tests/golden";
bool update = false;

json read_list() {
  return json::parse(std::ifstream(folder / "goldens.json"));
}

struct Golden {
  std::string bake, file;
  double tolerance;
};

void PrintTo(const Golden& golden, std::ostream* out) {
  *out << golden.bake << "/" << golden.file;
}

std::vector<Golden> goldens() {
  std::vector<Golden> all;
  const json list = read_list();
  for (const auto& [name, bake] : list["bakes"].items())
    for (const auto& golden : bake["goldens"]) all.push_back({name, golden["file"], golden["rel_rmse"]});
  return all;
}

// Runs a bake of goldens.json once and returns where its pictures are.
const fs::path& pictures_of(const std::string& bake) {
  static std::map<std::string, fs::path> done;
  auto& out = done[bake];
  if (!out.empty()) return out;
  out = fs::path(LICHTVELD_PICTURES) / bake;
  fs::remove_all(out);
  fs::create_directories(out);
  std::string options = read_list()["bakes"][bake]["options"];
  if (const auto at = options.find("OUT"); at != std::string::npos) options.replace(at, 3, out.string());
  const std::string command =
      std::string(LICHTVELD_BINARY) + " bake " LICHTVELD_SOURCE_DIR "/assets/cornell.glb " + options +
      " --validation --out " + (out / "irradiance.exr").string() + " --png " + (out / "map.png").string();
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return out;
}

class GoldenTest : public ::testing::TestWithParam<Golden> {};

std::vector<float> values_of(const OIIO::ImageBuf& image) {
  std::vector<float> values(image.spec().image_pixels() * image.nchannels());
  image.get_pixels(OIIO::ROI::All(), OIIO::TypeDesc::FLOAT, values.data());
  return values;
}

// sqrt(mean of squared differences) / mean of the golden's magnitudes, over all channels: alpha is coverage or
// depth.
double rel_rmse(const OIIO::ImageBuf& actual, const OIIO::ImageBuf& golden) {
  const auto a = values_of(actual), g = values_of(golden);
  double squares = 0, sum = 0;
  for (std::size_t i = 0; i < g.size(); ++i) {
    squares += (double{a[i]} - g[i]) * (double{a[i]} - g[i]);
    sum += std::abs(g[i]);
  }
  const auto values = static_cast<double>(g.size());
  return std::sqrt(squares / values) / (sum / values);
}

TEST_P(GoldenTest, IsAsItWas) {
  const auto& [bake, name, tolerance] = GetParam();
  const std::string file = name + (name == "map" ? ".png" : ".exr");
  const fs::path actual_file = pictures_of(bake) / file, golden_file = folder / bake / file;
  ASSERT_TRUE(fs::exists(actual_file)) << "the bake wrote no " << file;
  if (update) {
    fs::create_directories(golden_file.parent_path());
    OIIO::ImageBuf picture(actual_file.string());
    picture.specmod().attribute("compression", "zip");
    picture.specmod().attribute("DateTime", "");
    ASSERT_TRUE(picture.write(golden_file.string())) << picture.geterror();
    GTEST_SKIP() << golden_file << " is updated";
  }
  ASSERT_TRUE(fs::exists(golden_file)) << "no golden: run with --update-goldens and look at it";
  const OIIO::ImageBuf actual(actual_file.string()), golden(golden_file.string());
  ASSERT_EQ(actual.spec().width, golden.spec().width);
  ASSERT_EQ(actual.nchannels(), golden.nchannels());
  const double error = rel_rmse(actual, golden);
  RecordProperty("rel_rmse", std::to_string(error));
  if (error > tolerance) {
    const auto difference = OIIO::ImageBufAlgo::absdiff(actual, golden);
    const auto kept = pictures_of(bake) / (name + ".difference.exr");
    difference.write(kept.string(), OIIO::TypeDesc::FLOAT);
    const auto devices = lichtveld::gpu::list_devices();
    ADD_FAILURE() << file << " is " << error << " off, more than " << tolerance << "; golden drawn by "
                  << read_list()["driver"] << ", here "
                  << (devices.empty() ? "nothing" : devices.front().driver) << "; see " << actual_file
                  << " and " << kept;
  }
}

INSTANTIATE_TEST_SUITE_P(Goldens, GoldenTest, ::testing::ValuesIn(goldens()), [](const auto& test) {
  std::string name = test.param.bake + "_" + test.param.file;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
});

}  // namespace

int main(int argc, char** argv) {
  ::testing::InitGoogleMock(&argc, argv);
  update = argc > 1 && std::string(argv[1]) == "--update-goldens";
  return RUN_ALL_TESTS();
}
