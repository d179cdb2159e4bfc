// lichtveld bake and info: their files and what they report.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

#include <cmath>
#include <csignal>
#include <limits>
#include <nlohmann/json.hpp>

#include "commands_run.hpp"
#include "scene_builder.hpp"

namespace lichtveld::testing {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

class Bake : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  // Bakes the Cornell room small and returns all values of E.exr.
  std::vector<float> bake(const std::string& name, const std::string& options = "") {
    const auto ran =
        run("bake " + cornell + " --validation --size 64 --out " + path(name) + " " +
            (options.find("--bounces ") == std::string::npos ? "--bounces 2 " : "") +
            (options.find("--psf ") == std::string::npos && options.find("reference") == std::string::npos
                 ? "--psf 24 "
                 : "") +
            options);
    EXPECT_EQ(ran.status, 0) << ran.output;
    OIIO::ImageBuf image(path(name));
    std::vector<float> values(64 * 64 * 4);
    EXPECT_TRUE(image.get_pixels(OIIO::ROI::All(), OIIO::TypeDesc::FLOAT, values.data()));
    return values;
  }

  TempFolder folder_;
};

TEST_F(Bake, WritesFloatRgbaWithValidTexelsInAlpha) {
  const auto values = bake("E.exr");
  const auto file = OIIO::ImageInput::open(path("E.exr"));
  ASSERT_TRUE(file);
  EXPECT_EQ(file->spec().format, OIIO::TypeDesc::FLOAT);
  EXPECT_EQ(file->spec().tile_width, 0) << "scanlines";
  EXPECT_EQ(file->spec().channelnames, (std::vector<std::string>{"R", "G", "B", "A"}));
  for (std::size_t texel = 0; texel < values.size(); texel += 4)
    ASSERT_TRUE(values[texel + 3] == 0 || values[texel + 3] == 1);
}

TEST_F(Bake, LightGoesOnBeyondTheCharts) {
  const auto values = bake("E.exr");
  constexpr int size = 64;
  const auto at = [&](int x, int y, int channel) {
    return values[static_cast<std::size_t>(4 * (y * size + x) + channel)];
  };
  int beside_charts = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      if (at(x, y, 3) == 1) continue;
      constexpr int around = 2;
      bool is_beside = false;
      float least = std::numeric_limits<float>::max(), most = 0;
      for (int v = std::max(y - around, 0); v <= std::min(y + around, size - 1); ++v)
        for (int u = std::max(x - around, 0); u <= std::min(x + around, size - 1); ++u) {
          if (at(u, v, 3) != 1) continue;
          is_beside = is_beside || (std::abs(u - x) <= 1 && std::abs(v - y) <= 1);
          least = std::min(least, at(u, v, 0));
          most = std::max(most, at(u, v, 0));
        }
      if (!is_beside) continue;
      EXPECT_GE(at(x, y, 0), least * 0.9999f) << x << ", " << y;
      EXPECT_LE(at(x, y, 0), most * 1.0001f) << x << ", " << y;
      ++beside_charts;
    }
  EXPECT_GT(beside_charts, 100);
}

// A pillar through the floor.
TEST_F(Bake, BuriedTexelsTakeTheLightOfTheirNeighboursUnlessTheyAreToBeLit) {
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5f));
  builder.box("room", glm::vec3(-1, 0, -1), glm::vec3(1, 2, 1), {0, 0, 0.5f, 0.5f}, grey, true);
  builder.box("pillar", {-0.3f, -0.2f, -0.3f}, {0.3f, 1, 0.3f}, {0.5f, 0, 1, 0.5f},
              builder.material(glm::vec3(0.5f), glm::vec3(1)));
  const auto scene = folder_.write("pillar.glb", builder.glb());
  const auto bake_to = [&](const std::string& name, const std::string& options) {
    const auto ran = run("bake " + scene.string() + " --size 128 --bounces 2 --out " + path(name + ".exr") +
                         " --report " + path(name + ".json") + options);
    EXPECT_EQ(ran.status, 0) << ran.output;
    return json::parse(std::ifstream(path(name + ".json")));
  };
  for (const std::string method :
       {"rays --psf 24", "links --psf 24", "thesis --psf 24", "reference --spp 16"}) {
    EXPECT_GT(bake_to("neighbours", " --method " + method)["texels_buried"], 4) << method;
    EXPECT_FALSE(bake_to("lit", " --buried lit --method " + method).contains("texels_buried")) << method;
    const OIIO::ImageBuf taken(path("neighbours.exr")), lit(path("lit.exr"));
    EXPECT_GT(OIIO::ImageBufAlgo::compare(taken, lit, 0.05f, 0.05f).maxerror, 0.05) << method;
  }
  const auto refused = run("bake " + scene.string() + " --buried up --out " + path("E.exr"));
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.output, HasSubstr("--buried up: choose one of lit|neighbours"));
}

TEST_F(Bake, ReportsWhatItDid) {
  const auto values = bake("E.exr", "--method thesis --report " + path("r.json") + " --png " + path("map.png"));
  const auto report = json::parse(std::ifstream(path("r.json")));
  EXPECT_THAT(report["device"].get<std::string>(), HasSubstr("llvmpipe"));
  EXPECT_EQ(report["method"], "thesis");
  EXPECT_EQ(report["size"], 64);
  EXPECT_EQ(report["psf"], 24);
  EXPECT_EQ(report["psf_size"], 64);
  EXPECT_EQ(report["weights"], "solid-angle");
  EXPECT_EQ(report["seed"], 0);
  EXPECT_EQ(report["layers"], 8);
  EXPECT_EQ(report["bounces_used"], 2);
  EXPECT_GT(report["residual"], 0);
  int valid = 0;
  for (std::size_t texel = 0; texel < values.size(); texel += 4) valid += values[texel + 3] == 1;
  EXPECT_EQ(report["texels_valid"], valid);
  EXPECT_GE(report["depth_layers_max"], 2);
  EXPECT_EQ(report["overflow_pixels"], 0);
  EXPECT_LT(report["miss_fraction"], 0.03)
      << "the room is closed; stencil routing loses a layer here and there";
  EXPECT_GT(report["unknown_fraction"], 0) << "texels at the feet of walls have rays without a pixel";
  EXPECT_LT(report["unknown_fraction"], 0.05);
  EXPECT_GT(report["error_estimate"], 0.01);
  EXPECT_LT(report["error_estimate"], 1);
  EXPECT_GT(report["time_ms"]["total"], 0);
  for (const char* pass :
       {"geometry_texture", "emit_radiance", "stencil_routing", "blend", "brdf", "tone_map"}) {
    EXPECT_GT(report["time_ms"]["passes"][pass]["calls"], 0) << pass;
    EXPECT_GT(report["time_ms"]["passes"][pass]["gpu_ms"], 0) << pass;
  }
  EXPECT_GT(report["memory_bytes"]["lightfield/total_irradiance"], 0);
  std::int64_t sum = 0;
  for (const auto& [name, bytes] : report["memory_bytes"].items())
    sum += name == "total" ? 0 : bytes.get<std::int64_t>();
  EXPECT_EQ(report["memory_bytes"]["total"], sum);
  const OIIO::ImageBuf map(path("map.png"));
  EXPECT_EQ(map.spec().width, 64);
  EXPECT_EQ(map.nchannels(), 3);
}

TEST_F(Bake, TakesItsPsfSizeInPixelsOrTimesTheSize) {
  const auto usual = bake("1.exr", "--method links");
  const auto report = [&] { return json::parse(std::ifstream(path("r.json"))); };
  EXPECT_NE(bake("2.exr", "--method links --psf-size 2x --report " + path("r.json")), usual);
  EXPECT_EQ(report()["psf_size"], 128);
  EXPECT_NE(bake("3.exr", "--psf-size 0.5x --report " + path("r.json")), usual);
  EXPECT_EQ(report()["psf_size"], 32);
  EXPECT_EQ(bake("4.exr", "--psf-size 64 --report " + path("r.json")), usual);
  EXPECT_EQ(report()["psf_size"], 64);
}

TEST_F(Bake, ReportsWeightsAndSeed) {
  const auto usual = bake("1.exr", "--method links");
  EXPECT_NE(bake("2.exr", "--weights equal --seed 3 --report " + path("r.json")), usual);
  const auto report = json::parse(std::ifstream(path("r.json")));
  EXPECT_EQ(report["weights"], "equal");
  EXPECT_EQ(report["seed"], 3);
}

TEST_F(Bake, RaysAreTheUsualMethodOfACpu) {
  bake("E.exr", "--report " + path("r.json"));
  const auto report = json::parse(std::ifstream(path("r.json")));
  EXPECT_EQ(report["method"], "rays");
  EXPECT_EQ(report["bounces_used"], 2);
  EXPECT_GT(report["error_estimate"], 0);
  for (const char* stage : {"texel_records", "ray_index", "rows", "links", "direct_light", "bounces"})
    EXPECT_GT(report["time_ms"]["host"][stage]["ms"], 0) << stage;
}

// Lamps are exact, so that no more than what reflects is left to the directions.
TEST_F(Bake, LampsAreExactForEveryMethod) {
  const auto truth = bake("reference.exr", "--method reference --spp 2048 --bounces 1");
  double sum = 0;
  for (const float value : truth) sum += value;
  for (const char* method : {"rays", "links", "thesis --direct exact"}) {
    const auto light = bake("E.exr", std::string("--bounces 1 --method ") + method);
    double squares = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) squares += (light[i] - truth[i]) * (light[i] - truth[i]);
    const auto count = static_cast<double>(truth.size());
    EXPECT_LT(std::sqrt(squares / count) / (sum / count), 0.03) << method;
  }
}

TEST_F(Bake, AnErrorThatIsAskedForChoosesTheQuality) {
  const auto baked_with = [&](const std::string& options) {
    const auto ran =
        run("bake " + cornell + " --out " + path("E.exr") + " --report " + path("r.json") + " " + options);
    EXPECT_EQ(ran.status, 0) << ran.output;
    EXPECT_THAT(ran.output, ContainsRegex("--size [0-9]+ --psf [0-9]+: [0-9.]+ % off"));
    return json::parse(std::ifstream(path("r.json")));
  };
  const auto coarse = baked_with("--error 30%"), fine = baked_with("--error 0.03");
  EXPECT_LT(coarse["size"].get<int>() * coarse["size"].get<int>() * coarse["psf"].get<int>(),
            fine["size"].get<int>() * fine["size"].get<int>() * fine["psf"].get<int>());
  EXPECT_LT(fine["error_estimate"], 0.03);
  EXPECT_EQ(baked_with("--error 5% --size 32")["size"], 32);
}

TEST_F(Bake, LinksSayWhatTheyTake) {
  bake("E.exr", "--method links --report " + path("r.json"));
  const auto report = json::parse(std::ifstream(path("r.json")));
  EXPECT_EQ(report["method"], "links");
  EXPECT_EQ(report["bounces_used"], 2);
  EXPECT_GT(report["error_estimate"], 0);
  const int lines = (report["texels_valid"].get<int>() + 15) / 16;  // 16 texels lie together
  EXPECT_EQ(report["memory_bytes"]["lightfield/links 0"], 2 * 12 * 16 * lines);
  for (const char* pass :
       {"geometry_texture", "receivers", "emit_links", "emit_links_count", "route_links", "route_doubts",
        "route_rest", "link_cover", "gather", "link_bounce", "link_change", "brdf", "tone_map"})
    EXPECT_GT(report["time_ms"]["passes"][pass]["calls"], 0) << pass;
}

// Passes on the device and stages on the host are all of the time there is.
TEST_F(Bake, PartsOfItsTimeSumToTheTotal) {
  for (const char* method : {"links", "thesis"}) {
    bake("E.exr", std::string("--psf 96 --method ") + method + " --report " + path("r.json"));
    const auto time = json::parse(std::ifstream(path("r.json")))["time_ms"];
    double sum = 0;
    for (const auto& pass : time["passes"]) sum += pass["gpu_ms"].get<double>();
    for (const auto& stage : time["host"]) sum += stage["ms"].get<double>();
    // The host works on while the device draws, which counts twice: some of it here, where all takes little.
    EXPECT_NEAR(sum / time["total"].get<double>(), 1, 0.2) << time.dump(1);
    for (const char* stage : {"texel_records", "pipelines", "find_walls", "set_up"})
      EXPECT_GT(time["host"][stage]["ms"], 0) << stage;
    EXPECT_GT(time["passes"]["upload"]["calls"], 0) << "what set-up costs the device is there, too";
  }
}

TEST_F(Bake, OptionsOfTheThesisAskForIt) {
  for (const char* option : {"--abuffer list", "--sort scan"}) {
    bake("E.exr", std::string(option) + " --report " + path("r.json"));
    EXPECT_EQ(json::parse(std::ifstream(path("r.json")))["method"], "thesis");
  }
}

TEST(Links, ThatDoNotFitAreRefusedBeforeTheyAreMade) {
  const TempFolder folder;
  const auto ran = run("bake " + cornell + " --method links --size 2048 --psf 6144 --out " +
                       (folder.path() / "E.exr").string());
  EXPECT_EQ(ran.status, 1);
  EXPECT_THAT(ran.output, AllOf(HasSubstr("links of"), HasSubstr("MiB"), HasSubstr("--method thesis")));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// With 2 GB of address space.
TEST(Bakes, WithoutMemoryAreRefusedWithAdvice) {
  const TempFolder folder;
  const auto out = (folder.path() / "E.exr").string();
  const auto bake = [&](const std::string& options) {
    return shell("ulimit -v 2097152; timeout 60 " LICHTVELD_BINARY " bake " + cornell + " --out " + out +
                 options + " 2>&1");
  };
  const auto large = bake(" --size 1024 --psf 1536");
  EXPECT_EQ(large.status, 1);
  EXPECT_THAT(large.output, AllOf(HasSubstr("MiB"), HasSubstr("--size")));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_EQ(bake(" --size 128").status, 0);
  EXPECT_EQ(run("bake " + cornell + " --memory 1M --size 64 --out " + out).status, 1);
}

TEST_F(Bake, LiveMovesEndWhereAFreshBakeDoes) {
  const std::string moves = "--move cube1=-0.4,0.3,0 --move cube2=0.2,0,0.1 --move cube1=0.1,0,0";
  for (const std::string method : {"rays", "links"}) {
    const auto by = "--method " + method + " ";
    const auto fresh = bake("fresh.exr", by + moves),
               live = bake("live.exr", by + moves + " --live --report " + path("r.json")),
               rest = bake("rest.exr", by);
    const auto report = json::parse(std::ifstream(path("r.json")));
    if (method == "links") {
      EXPECT_EQ(report["links"]["checked"], report["texels_valid"].get<int>() * report["psf"].get<int>() / 2);
      EXPECT_EQ(report["links"]["differing"], 0);
    }
    EXPECT_EQ(fresh, live);
    EXPECT_NE(fresh, rest);
    EXPECT_EQ(fresh, bake("sum.exr", by + "--move cube1=-0.3,0.3,0 --move cube2=0.2,0,0.1"));
  }
}

// The light field against path tracing: a wrong side, weight or bounce would show here as bias.
TEST_F(Bake, AgreesWithTheReference) {
  const auto traced = bake("reference.exr", "--method reference --spp 1024 --png " + path("reference.png") +
                                                " --report " + path("r.json"));
  const auto field = bake("field.exr", "--psf 1536 --png " + path("field.png"));
  double difference = 0, sum = 0;
  for (std::size_t i = 0; i < traced.size(); ++i) {
    if (i % 4 == 3) {
      ASSERT_EQ(traced[i], field[i]) << "the same texels are valid";
    } else {
      difference += field[i] - traced[i];
      sum += traced[i];
    }
  }
  std::printf("light field against reference: bias %.3f %%\n", 100 * difference / sum);
  EXPECT_LT(std::abs(difference / sum), 0.01);
  const auto report = json::parse(std::ifstream(path("r.json")));
  EXPECT_EQ(report["method"], "reference");
  EXPECT_GT(report["standard_error"], 0);
  EXPECT_LT(report["standard_error"], 0.05);
  const auto shown = OIIO::ImageBufAlgo::compare(OIIO::ImageBuf(path("reference.png")),
                                                 OIIO::ImageBuf(path("field.png")), 1, 1);
  EXPECT_LT(shown.meanerror, 0.02) << "both are presented alike";
}

TEST_F(Bake, DumpsEveryPass) {
  bake("E.exr", "--dump " + path("dump"));
  for (const char* stage : {"geometry_texture.position", "emit_radiance.layer0",
                            "stencil_routing.psf_irradiance", "blend.total_irradiance", "brdf.radiance"})
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "dump" / (std::string(stage) + ".exr"))) << stage;
}

// A minute and more of paths, ended after some seconds by what Ctrl-C sends.
Ran interrupted(const TempFolder& folder, const std::string& seconds, bool on_terminal) {
  const std::string bake = LICHTVELD_BINARY " bake " + cornell + " --method reference --spp 1000000 --out " +
                           (folder.path() / "e.exr").string() + " --report " +
                           (folder.path() / "r.json").string();
  return shell("timeout --preserve-status -s INT " + seconds +
               (on_terminal ? " script -qec '" + bake + "' /dev/null" : " " + bake) + " 2>&1 </dev/null");
}

TEST_F(Bake, LongOnesSayHowFarTheyAreAndEndAtOnceWhenInterrupted) {
  const auto ran = interrupted(folder_, "6", false);
  EXPECT_EQ(ran.status, 128 + SIGINT) << ran.output;
  EXPECT_LT(ran.seconds, 7);
  EXPECT_THAT(ran.output, ContainsRegex("tracing paths, [0-9]+ %(, about [0-9]+ (s|min) left)?"));
  EXPECT_THAT(ran.output, Not(HasSubstr("["))) << "a bar is for terminals";
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(Bake, ABarIsDrawnOnATerminal) {
  const auto ran = interrupted(folder_, "4", true);
  EXPECT_THAT(ran.output, ContainsRegex("\\[[#.]+\\] tracing paths, [0-9]+ %"));
}

TEST(Info, ListsDevicesAndWhatASceneNeeds) {
  const auto ran = run("info " + cornell);
  EXPECT_EQ(ran.status, 0);
  for (const char* words : {"llvmpipe", "samples a pixel      4 (8 stencil-routed layers take 2 passes)",
                            "usable               yes", "cube1", "cube2", "valid texels"})
    EXPECT_THAT(ran.output, HasSubstr(words));
}

TEST(Version, NamesTheCommitTheDeviceAndTheLibraries) {
  const auto ran = run("--version");
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_THAT(
      ran.output,
      MatchesRegex("lichtveld [0-9]+\\.[0-9]+\\.[0-9]+ \\((unknown|[0-9a-f]{12,40}(-dirty)?)\\)\n(.|\n)*"));
  EXPECT_THAT(ran.output, HasSubstr("device               llvmpipe"));
  for (const char* library :
       {"Vulkan headers", "Embree", "OpenImageIO", "libdatachannel", "nlohmann json", "spdlog", "fmt", "CLI11"})
    EXPECT_THAT(ran.output, ContainsRegex(std::string(library) + " +[0-9]+\\.[0-9]+")) << library;
}

TEST(Version, IsStatus0WithoutADevice) {
  const auto ran = run("--version", "VK_ICD_FILENAMES=/nonexistent VK_DRIVER_FILES=/nonexistent");
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("no Vulkan device"));
}

TEST(Help, IsStatus0) {
  EXPECT_EQ(run("--help").status, 0);
  for (const char* command : {"bake", "serve", "info", "bench"})
    EXPECT_EQ(run(std::string(command) + " --help").status, 0) << command;
}

}  // namespace
}  // namespace lichtveld::testing
