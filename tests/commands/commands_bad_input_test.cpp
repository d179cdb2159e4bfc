// What strangers get wrong: the exit status, and a message that names the culprit and what to try.
#include <gmock/gmock.h>

#include <csignal>

#include "commands_run.hpp"
#include "scene_builder.hpp"

namespace lichtveld::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct BadUse {
  const char* name;
  std::string arguments;
  int status;
  std::vector<std::string> says;
};

void PrintTo(const BadUse& use, std::ostream* out) {
  *out << use.arguments;
}

class BadUsage : public ::testing::TestWithParam<BadUse> {};

TEST_P(BadUsage, IsNamed) {
  const auto& use = GetParam();
  const TempFolder folder;
  std::string arguments = use.arguments;
  for (auto at = arguments.find("OUT"); at != std::string::npos; at = arguments.find("OUT"))
    arguments.replace(at, 3, (folder.path() / "E.exr").string());
  const auto ran = run(arguments);
  EXPECT_EQ(ran.status, use.status) << ran.output;
  for (const auto& words : use.says) EXPECT_THAT(ran.output, HasSubstr(words));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "something half-written is left behind";
}

const std::string bake = "bake " + cornell + " --out OUT --size 32 --psf 8 --bounces 1 ";
const std::string long_name(300, 'x');

INSTANTIATE_TEST_SUITE_P(
    CommandLine, BadUsage,
    ::testing::Values(
        BadUse{"NoCommand", "", 2, {"subcommand", "--help"}}, BadUse{"UnknownCommand", "paint", 2, {"--help"}},
        BadUse{"UnknownOption", bake + "--colour red", 2, {"--colour"}},
        BadUse{"NoOut", "bake " + cornell, 2, {"--out"}},
        BadUse{"NoScene", "bake nowhere.glb --out OUT", 2, {"nowhere.glb"}},
        BadUse{"SceneIsAFolder", "bake /tmp --out OUT", 2, {"/tmp"}},
        BadUse{"LinksWithASort", bake + "--method links --sort scan", 2, {"--sort", "links", "leave it out"}},
        BadUse{"ServeLinksWithAnABuffer",
               "serve --method links --abuffer list --scene " + cornell +
                   " --signaling ws://127.0.0.1:1/server --token-file nowhere",
               2,
               {"--abuffer", "links"}},
        BadUse{"StepBounces",
               "serve --step-bounces 0.7 --scene " + cornell +
                   " --signaling ws://127.0.0.1:1/server --token-file nowhere",
               2,
               {"0.7", "0.5", "whole"}},
        BadUse{"StepBouncesOfThesis",
               "serve --method thesis --step-bounces 1 --scene " + cornell +
                   " --signaling ws://127.0.0.1:1/server --token-file nowhere",
               2,
               {"--step-bounces", "links", "leave it out"}},
        BadUse{"ServeReference",
               "serve --method reference --scene " + cornell +
                   " --signaling ws://127.0.0.1:1/server --token-file nowhere",
               2,
               {"reference", "thesis"}},
        BadUse{"ReferenceWithPsf", bake + "--method reference", 2, {"--psf", "reference", "leave it out"}},
        BadUse{"SppOfNoReference", bake + "--spp 16", 2, {"--spp", "auto", "reference", "leave it out"}},
        BadUse{"RaysWithAPsfSize", bake + "--method rays --psf-size 2x", 2, {"--psf-size", "thesis, links"}},
        BadUse{
            "OptionsThatNoMethodHasTogether", bake + "--sets 4 --weights equal", 2, {"auto", "leave it out"}},
        BadUse{"Error", bake + "--error none", 2, {"--error none", "2%"}},
        BadUse{"ErrorNegative", bake + "--error=-1%", 2, {"--error -1%", "2%"}},
        BadUse{"DumpPsf", bake + "--dump-psf 8", 2, {"--dump-psf 8", "0..7"}},
        BadUse{"DumpIntoAFile", bake + "--dump /dev/null", 2, {"/dev/null", "folder"}},
        BadUse{"OutIsNoExr", "bake " + cornell + " --out OUT.png --psf 8", 2, {".exr"}},
        BadUse{"GltfIsNoGlb", bake + "--gltf OUT.gltf", 2, {".glb", "name it so"}},
        BadUse{"GltfInNoFolder", bake + "--gltf /nowhere/lit.glb", 2, {"/nowhere", "folder"}},
        BadUse{"GltfInAnotherFolder", bake + "--gltf /tmp/lit.glb", 2, {"two folders", "beside"}},
        BadUse{
            "GltfIsTheScene", "bake OUT.glb --out OUT --gltf OUT.glb", 2, {"the scene", "--gltf", "same file"}},
        BadUse{"GltfOfMovedNodes",
               bake + "--gltf OUT.glb --move cube1=0.1,0,0",
               2,
               {"--gltf", "--move", "leave one out"}},
        BadUse{"Spp", "bake " + cornell + " --out OUT --method reference --spp 0", 2, {"0", "1..1000000"}},
        BadUse{"UnknownMethod", bake + "--method magic", 2, {"magic", "thesis"}},
        BadUse{"UnknownABuffer", bake + "--abuffer magic", 2, {"magic", "list|stencil"}},
        BadUse{"UnknownSort", bake + "--sort magic", 2, {"magic", "bitonic|compare-swap|scan"}},
        BadUse{"Psf", "bake " + cornell + " --out OUT --psf 100", 2, {"100 PSFs", "8, 24, 32, 96, 128, 384"}},
        BadUse{"PsfNotANumber", "bake " + cornell + " --out OUT --psf many", 2, {"--psf"}},
        BadUse{"SizeTooSmall", "bake " + cornell + " --out OUT --size 4", 2, {"4 texels", "16..4096"}},
        BadUse{"SizeTooLarge", "bake " + cornell + " --out OUT --size 100000", 2, {"100000", "16..4096"}},
        BadUse{"SizeNegative", "bake " + cornell + " --out OUT --size -5", 2, {"--size"}},
        BadUse{"PsfSizeWord", bake + "--psf-size x", 2, {"--psf-size x", "2x"}},
        BadUse{"PsfSizeUnit", bake + "--psf-size 2y", 2, {"--psf-size 2y", "2x"}},
        BadUse{"PsfSizeZero", bake + "--psf-size 0", 2, {"--psf-size 0", "2x"}},
        BadUse{"PsfSizeNegative", bake + "--psf-size -1", 2, {"--psf-size"}},
        BadUse{"PsfSizeNoWholePixels", bake + "--psf-size 20.5", 2, {"--psf-size 20.5", "2x"}},
        BadUse{"PsfSizeTooSmall", bake + "--psf-size 0.01x", 2, {"PSF raster of 1 ", "16..8192"}},
        BadUse{"PsfSizeTooLarge", bake + "--psf-size 9000", 2, {"--psf-size 9000", "16..8192"}},
        BadUse{"Weights", bake + "--weights heavy", 2, {"heavy", "equal|solid-angle"}},
        BadUse{"ReferenceWithPsfSize",
               "bake " + cornell + " --out OUT --method reference --psf-size 2x",
               2,
               {"--psf-size", "reference", "leave it out"}},
        BadUse{"ReferenceWithWeights",
               "bake " + cornell + " --out OUT --method reference --weights equal",
               2,
               {"--weights", "reference", "leave it out"}},
        BadUse{"Bounces", "bake " + cornell + " --out OUT --bounces 0", 2, {"--bounces 0", "auto"}},
        BadUse{"BouncesWord", "bake " + cornell + " --out OUT --bounces many", 2, {"--bounces many", "auto"}},
        BadUse{"Layers", bake + "--layers 0", 2, {"1..128"}},
        BadUse{"CaptureIsNoRdc", bake + "--capture c.png", 2, {"c.png", ".rdc"}},
        BadUse{"CaptureFolderMissing", bake + "--capture /nowhere/c.rdc", 2, {"/nowhere", "folder"}},
        BadUse{"CaptureOfReference",
               "bake " + cornell + " --out OUT --method reference --capture c.rdc",
               2,
               {"--capture", "reference", "leave it out"}},
        BadUse{"CaptureAfterNoCapture", bake + "--live --capture-after 1", 2, {"--capture-after", "--capture"}},
        BadUse{"CaptureAfterWithoutLive",
               bake + "--capture c.rdc --capture-after 1",
               2,
               {"--capture-after", "--live", "leave it out"}},
        BadUse{"CaptureAfterTheLast",
               bake + "--live --move cube1=0.1,0,0 --capture c.rdc --capture-after 2",
               2,
               {"--capture-after 2", "2 updates", "0..1"}},
        BadUse{
            "CaptureAfterNegative", bake + "--live --capture c.rdc --capture-after -1", 2, {"--capture-after"}},
        BadUse{"CaptureOfServe",
               "serve --capture c.png --scene " + cornell +
                   " --signaling ws://127.0.0.1:1/server --token-file nowhere",
               2,
               {"c.png", ".rdc"}},
        BadUse{"MoveWithoutNumbers", bake + "--move cube1", 2, {"--move cube1", "NODE=dx,dy,dz"}},
        BadUse{"MoveShort", bake + "--move cube1=1,2", 2, {"NODE=dx,dy,dz"}},
        BadUse{"MoveNan", bake + "--move cube1=nan,0,0", 2, {"NODE=dx,dy,dz"}},
        BadUse{"MoveUnknown", bake + "--move sofa=1,0,0", 2, {"sofa", "cube1, cube2"}},
        BadUse{"MoveFixed", bake + "--move floor=1,0,0", 2, {"floor", "cube1, cube2"}},
        BadUse{"OutFolderMissing",
               "bake " + cornell + " --out OUT/no/E.exr --size 32 --psf 8 --bounces 1",
               2,
               {"not a folder"}},
        BadUse{"OutIsAFolder",
               "bake " + cornell + " --out /tmp --size 32 --psf 8 --bounces 1",
               2,
               {"/tmp", "it is a folder"}},
        BadUse{"OutNameTooLong",
               "bake " + cornell + " --out /tmp/" + long_name + ".exr",
               2,
               {"too long", "shorter"}},
        BadUse{"ReportNameTooLong", bake + "--report OUT" + long_name, 2, {"too long", "shorter"}},
        BadUse{"DumpNameTooLong", bake + "--method thesis --dump /tmp/" + long_name, 2, {"folder", "too long"}},
        BadUse{"BenchOutNameTooLong",
               "bench --scene " + cornell + " --out /tmp/" + long_name,
               2,
               {"folder", "too long"}},
        BadUse{"OutAndReportAreOne", bake + "--report OUT", 2, {"--out", "--report", "same file", "its own"}},
        BadUse{"OutAndReportAreOneSpeltOtherwise", bake + "--report OUT/../E.exr", 2, {"same file"}},
        BadUse{"OutIsOfADumpedPass",
               "bake " + cornell + " --method thesis --out /tmp/brdf.radiance.exr --dump /tmp",
               2,
               {"--out", "--dump", "brdf.radiance.exr"}},
        BadUse{"BenchSort", "bench --sort scan,magic", 2, {"magic", "bitonic|compare-swap|scan"}},
        BadUse{"BenchWeights", "bench --weights heavy", 2, {"heavy", "solid-angle|equal"}},
        BadUse{"BenchPsfSize", "bench --psf-size 3y", 2, {"3y", "2x"}},
        BadUse{"BenchPsf", "bench --scene " + cornell + " --psf 24,100", 2, {"100 PSFs", "8, 24, 32"}},
        BadUse{"BenchRepeats", "bench --repeats 0", 2, {"--repeats 0", "at least 1"}},
        BadUse{"BenchSpp", "bench --spp 0", 2, {"--spp 0", "2..1000000"}},
        BadUse{"BenchUpdates", "bench --updates -3", 2, {"--updates"}},
        BadUse{"BenchUnknownOption", "bench --fast", 2, {"--fast"}},
        BadUse{"BenchTwoScenesOfOneName",
               "bench --scene " + cornell + " --scene " + cornell,
               2,
               {"two cornell", "file's name"}},
        BadUse{"NoSuchDevice", bake + "--device sofa", 3, {"sofa", "llvmpipe"}},
        BadUse{"ServeWithoutToken",
               "serve --scene " + cornell + " --signaling ws://127.0.0.1:1/server --token-file nowhere",
               2,
               {"--token-file", "nowhere"}},
        BadUse{"ServeEmptyToken",
               "serve --scene " + cornell + " --signaling ws://127.0.0.1:1/server --token-file /dev/null",
               2,
               {"/dev/null", "empty"}},
        BadUse{
            "ServeRate",
            "serve --scene " + cornell + " --signaling ws://127.0.0.1:1/server --token-file /dev/null --rate 0",
            2,
            {"--rate"}},
        BadUse{
            "ServeNoCaFile",
            "serve --scene " + cornell + " --signaling wss://a/server --ca-file nowhere --token-file nowhere",
            2,
            {"--ca-file nowhere", "PEM"}},
        BadUse{"ServeCaFileWithoutTls",
               "serve --scene " + cornell + " --signaling ws://a/server --ca-file nowhere --token-file nowhere",
               2,
               {"--ca-file", "wss://"}},
        BadUse{"ServePortsInDisorder",
               "serve --scene " + cornell + " --signaling ws://a/server --udp-port 5-2 --token-file nowhere",
               2,
               {"--udp-port 5-2", "before"}},
        BadUse{"ServeNoPort",
               "serve --scene " + cornell + " --signaling ws://a/server --udp-port 0x50 --token-file nowhere",
               2,
               {"--udp-port 0x50", "1 to 65535"}},
        BadUse{"ServeNoPublicAddress",
               "serve --scene " + cornell +
                   " --signaling ws://a/server --public-ip room.example --token-file nowhere",
               2,
               {"--public-ip", "room.example"}},
        BadUse{"ServeBadUrl",
               "serve --size 32 --psf 8 --scene " + cornell +
                   " --signaling gopher:hole --token-file " LICHTVELD_SOURCE_DIR "/LICENSE",
               2,
               {"gopher:hole"}}),
    [](const auto& use) { return use.param.name; });

TEST(BadDevice, NoDriverIsStatus3) {
  const std::string none = "VK_ICD_FILENAMES=/nonexistent VK_DRIVER_FILES=/nonexistent";
  for (const auto& command : {std::string("info"), "bake " + cornell + " --out /tmp/x.exr"}) {
    const auto ran = run(command, none);
    EXPECT_EQ(ran.status, 3) << ran.output;
    EXPECT_THAT(ran.output, HasSubstr("mesa-vulkan-drivers"));
  }
}

TEST(BadDevice, MissingValidationLayersAreNamed) {
  const TempFolder folder;
  const auto ran = run("bake " + cornell + " --validation --out /tmp/x.exr",
                       "XDG_DATA_DIRS=/nonexistent VK_LAYER_PATH=" + folder.path().string());
  EXPECT_EQ(ran.status, 3) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("vulkan-validationlayers"));
}

TEST(BadScene, IsNamedWithItsNodes) {
  const TempFolder folder;
  SceneBuilder builder;
  const int grey = builder.material(glm::vec3(0.5), glm::vec3(1));
  builder.box("table", glm::vec3(-1), glm::vec3(1), {0, 0, 1, 1}, grey);
  builder.box("chair", glm::vec3(2), glm::vec3(3), {0, 0, 0.5f, 0.5f}, grey);
  const auto file = folder.write("overlap.glb", builder.glb()).string();
  const auto ran = run("bake " + file + " --keep-uv --out " + (folder.path() / "E.exr").string());
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.output, AllOf(HasSubstr("table"), HasSubstr("chair"), HasSubstr("--keep-uv")));
  const auto cut = folder.write("cut.glb", builder.glb().substr(0, 200)).string();
  const auto truncated = run("bake " + cut + " --out " + (folder.path() / "E.exr").string());
  EXPECT_EQ(truncated.status, 2);
  EXPECT_THAT(truncated.output, HasSubstr("cut.glb"));
}

// The disk is "full" after 512 bytes.
TEST(BadOutput, AnOlderFileSurvivesAFailureToWrite) {
  const TempFolder folder;
  const auto old = folder.write("E.exr", "an older result");
  const auto ran = run("bake " + cornell + " --size 128 --psf 8 --bounces 1 --out " + old.string(),
                       "trap '' XFSZ; ulimit -f 1;");
  EXPECT_EQ(ran.status, 2) << ran.output;
  EXPECT_THAT(ran.output, AllOf(HasSubstr(old.string()), HasSubstr("cannot be written")));
  EXPECT_EQ(std::filesystem::file_size(old), 15u);
  const std::filesystem::directory_iterator files(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1) << "a temporary file is left behind";
}

TEST(BadOutput, TheSceneIsNeverWrittenOver) {
  const TempFolder folder;
  const auto scene = folder.path() / "room.glb", link = folder.path() / "E.exr";
  std::filesystem::copy_file(cornell, scene);
  std::filesystem::create_symlink("room.glb", link);
  const std::string quick = "bake " + scene.string() + " --size 32 --psf 8 --bounces 1 ";
  for (const auto& outputs : {"--out " + link.string(),
                              "--out " + (folder.path() / "2.exr").string() + " --report " + scene.string()}) {
    const auto ran = run(quick + outputs);
    EXPECT_EQ(ran.status, 2) << ran.output;
    EXPECT_THAT(ran.output, AllOf(HasSubstr("the scene"), HasSubstr("same file")));
  }
  EXPECT_EQ(std::filesystem::file_size(scene), std::filesystem::file_size(cornell));
}

TEST(Outputs, AreWrittenIntoDevices) {
  const TempFolder folder;
  const auto ran = run("bake " + cornell + " --size 32 --psf 8 --bounces 1 --report /dev/null --out " +
                       (folder.path() / "E.exr").string());
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(Outputs, WaitForAPipesReaderUntilASignal) {
  const TempFolder folder;
  const auto pipe = (folder.path() / "pipe").string(), out = (folder.path() / "E.exr").string();
  const auto command = "bake " + cornell + " --size 32 --psf 8 --bounces 1 --report " + pipe + " --out " + out;
  const auto read = shell("mkfifo " + pipe + "; cat " + pipe + " & " LICHTVELD_BINARY " " + command + "; wait");
  EXPECT_THAT(read.output, HasSubstr("texels_valid"));
  // Waits for its first output, so for the moment when only the pipe is left.
  const auto alone = shell("rm " + out + "; " LICHTVELD_BINARY " " + command + " & p=$!; until [ -e " + out +
                           " ] || ! kill -0 $p; do sleep 0.1; done; sleep 0.2; kill -INT $p; kill $p; wait $p");
  EXPECT_EQ(alone.status, 128 + SIGTERM) << alone.output;  // a shell's job in the background ignores SIGINT
  const std::filesystem::directory_iterator files(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 2) << "a temporary file is left behind";
}

TEST(Serve, EndsOnASecondSignalWhateverItDoes) {
  const TempFolder folder;
  const auto token = folder.write("token", "secret").string();
  // A first light map of minutes, which the first signal waits for.
  const auto ran = shell(LICHTVELD_BINARY " serve --method thesis --size 1024 --psf 6144 --scene " + cornell +
                         " --signaling ws://127.0.0.1:1/server --token-file " + token +
                         " >/dev/null 2>&1 & p=$!; sleep 1; kill $p; sleep 2; kill $p; wait $p");
  EXPECT_EQ(ran.status, 128 + SIGTERM);
  EXPECT_LT(ran.seconds, 10);
}

TEST(Serve, EndsAtOnceOnSigtermWhileSignalingIsAway) {
  const TempFolder folder;
  const auto token = folder.write("token", "secret").string();
  const auto ran = run("serve --size 32 --psf 8 --scene " + cornell +
                           " --signaling ws://127.0.0.1:1/server --token-file " + token,
                       "timeout --signal=TERM 5");
  EXPECT_EQ(ran.status, 124) << ran.output;  // timeout's own: it had to ask
  EXPECT_THAT(ran.output, AllOf(HasSubstr("stopped: 0 maps"), Not(HasSubstr("Killed"))));
  EXPECT_LT(ran.seconds, 8);
}

}  // namespace
}  // namespace lichtveld::testing
