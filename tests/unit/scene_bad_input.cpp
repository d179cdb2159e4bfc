// Each damaged or hostile file gets a message that names what is wrong; none crashes, hangs or takes memory.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <random>
#include <sstream>

#include "lichtveld/scene/scene.hpp"
#include "scene_damage.hpp"
#include "scene_log.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;
using testing::LogCapture;

class SceneBadInput : public ::testing::Test {
 protected:
  LogCapture log_;  // of each test's own
};

json nested(int depth) {
  return depth ? json::array({nested(depth - 1)}) : json::array();
}

// The floor's node gets a light.
std::function<void(SceneBuilder&)> with_light(const json& light, const json& number = 0) {
  return [=](SceneBuilder& builder) {
    builder.gltf["extensions"]["KHR_lights_punctual"]["lights"] = {light};
    builder.gltf["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = number;
  };
}

const std::vector<SpoiltCase> spoilt_cases = {
    {"LightOutside", with_light({{"type", "point"}}, 1), "node \"floor\": light: there is no light 1"},
    {"LightOfNoKind", with_light({{"type", "disco"}}), "no light of type \"disco\""},
    {"LightNegative", with_light({{"type", "point"}, {"intensity", -1}}), "intensity is -1"},
    {"LightHuge", with_light({{"type", "point"}, {"intensity", 1e300}}), "it must be at most 1e12"},
    {"LightColour", with_light({{"type", "point"}, {"color", {1, -2, 1}}}), "color is -2"},
    {"LightRange", with_light({{"type", "point"}, {"range", -1}}), "range is -1"},
    {"SpotInsideOut",
     with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.4}}}}),
     "innerConeAngle is 0.5"},
    {"LightRadius", with_light({{"type", "point"}, {"extras", {{"radius", -1}}}}), "extras.radius is -1"},
    {"NoPosition", [](auto& b) { attributes(b).erase("POSITION"); }, "primitive 0 has no POSITION"},
    {"PositionNan", [](auto& b) { overwrite(b, 0, 0, std::nanf("")); }, "vertex 0 is not finite"},
    {"PositionFar", [](auto& b) { overwrite(b, 0, 0, 1e30f); }, "more than 1000 km away"},
    {"IndexOutside", [](auto& b) { overwrite(b, 2, 1, std::uint16_t{4}); }, "index 4 of 4 vertices"},
    {"NoTriangles", [](auto& b) { b.gltf["nodes"][0].erase("mesh"); }, "no triangles"},
    {"Lines", [](auto& b) { b.primitive(0)["mode"] = 1; }, "no triangles"},
    {"UnknownMode", [](auto& b) { b.primitive(0)["mode"] = 9; }, "unknown mode 9"},
    {"HalfTriangle", [](auto& b) { b.gltf["accessors"][2]["count"] = 5; },
     "5 corners are no whole number of triangles"},
    {"Cycle", [](auto& b) { b.gltf["nodes"][1]["children"] = {0}; }, "node \"floor\" is reached twice"},
    {"TwoParents",
     [](auto& b) {
       b.gltf["nodes"][0]["children"] = {1, 1};
     },
     "node \"child\" is reached twice"},
    {"ChildOutside", [](auto& b) { b.gltf["nodes"][0]["children"] = {7}; },
     "node \"floor\": there is no node 7"},
    {"ChildNegative", [](auto& b) { b.gltf["nodes"][0]["children"] = {-1}; }, "there is no node -1"},
    {"NoScene", [](auto& b) { b.gltf["scene"] = 3; }, "there is no scene 3"},
    {"MeshOutside", [](auto& b) { b.gltf["nodes"][0]["mesh"] = 5; }, "there is no mesh 5"},
    {"MaterialOutside", [](auto& b) { b.primitive(0)["material"] = 5; }, "primitive 0: there is no material 5"},
    {"AccessorOutside", [](auto& b) { attributes(b)["POSITION"] = 99; }, "POSITION: there is no accessor 99"},
    {"AccessorType", [](auto& b) { attributes(b)["POSITION"] = 1; },
     "POSITION (accessor 1): expected VEC3 of float"},
    {"IndexType", [](auto& b) { b.primitive(0)["indices"] = 1; }, "expected SCALAR of unsigned"},
    {"ViewOutside", [](auto& b) { b.gltf["accessors"][0]["bufferView"] = 9; }, "there is no buffer view 9"},
    {"AccessorOffset", [](auto& b) { b.gltf["accessors"][0]["byteOffset"] = 4; }, "do not fit buffer view 0"},
    {"AccessorOffsetHuge", [](auto& b) { b.gltf["accessors"][0]["byteOffset"] = ~0ull; },
     "do not fit buffer view 0"},
    {"AccessorOffsetNegative", [](auto& b) { b.gltf["accessors"][0]["byteOffset"] = -4; },
     "no whole number of bytes"},
    {"CountHuge", [](auto& b) { b.gltf["accessors"][0]["count"] = ~0ull; }, "do not fit buffer view 0"},
    {"CountWraps", [](auto& b) { b.gltf["accessors"][0]["count"] = (1ull << 62) + 1; },
     "do not fit buffer view 0"},
    {"CountZero", [](auto& b) { b.gltf["accessors"][0]["count"] = 0; }, "is empty"},
    {"Stride", [](auto& b) { b.gltf["bufferViews"][0]["byteStride"] = 252; }, "do not fit buffer view 0"},
    {"StrideSmall", [](auto& b) { b.gltf["bufferViews"][0]["byteStride"] = 4; }, "less than an element"},
    {"ViewOffset", [](auto& b) { b.gltf["bufferViews"][0]["byteOffset"] = 1 << 20; }, "do not lie in buffer 0"},
    {"ViewWraps", [](auto& b) { b.gltf["bufferViews"][0]["byteLength"] = ~0ull; }, "do not lie in buffer 0"},
    {"ViewBuffer", [](auto& b) { b.gltf["bufferViews"][0]["buffer"] = 4; }, "there is no buffer 4"},
    {"BufferHuge",
     [](auto& b) {
       b.gltf["buffers"] = {{{"byteLength", 1ull << 40}}};
     },
     "larger than 1 GiB"},
    {"BufferLies",
     [](auto& b) {
       b.gltf["buffers"] = {{{"byteLength", 1 << 20}}};
     },
     "Invalid `byteLength'"},
    {"BufferTwice",
     [](auto& b) {
       b.gltf["buffers"] = {{{"byteLength", 4}}, {{"byteLength", 4}}};
     },
     "buffer 1 has no uri"},
    {"BufferEscapes",
     [](auto& b) {
       b.gltf["buffers"] = {{{"byteLength", 4}, {"uri", "../../etc/passwd"}}};
     },
     "leaves the scene's folder"},
    {"BufferHidden",
     [](auto& b) {
       b.gltf["buffers"] = {{{"byteLength", 4}, {"uri", "%2e%2e/x"}}};
     },
     "leaves the scene's folder"},
    {"BufferAbsolute",
     [](auto& b) {
       b.gltf["buffers"] = {{{"byteLength", 4}, {"uri", "/etc/passwd"}}};
     },
     "leaves the scene's folder"},
    {"TextureOutside",
     [](auto& b) {
       b.gltf["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 3}};
     },
     "there is no texture 3"},
    {"ImageOutside",
     [](auto& b) {
       b.gltf["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
       b.gltf["textures"] = {{{"source", 4}}};
     },
     "has no image 4"},
    {"ImageGarbage",
     [](auto& b) {
       b.gltf["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
       b.gltf["textures"] = {{{"source", 0}}};
       b.gltf["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
     },
     "image 0 is no PNG, JPEG or WebP"},
    {"ImageBroken",
     [](auto& b) {
       b.gltf["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
       b.gltf["textures"] = {{{"source", 0}}};
       b.gltf["images"] = {{{"uri", "data:image/jpeg;base64,/9j/2wAA"}}};
     },
     "image 0 does not decode"},
    {"ImageMissing",
     [](auto& b) {
       b.gltf["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
       b.gltf["textures"] = {{{"source", 0}}};
       b.gltf["images"] = {{{"uri", "absent.png"}}};
     },
     "image 0 (absent.png) is missing"},
    {"ImageView",
     [](auto& b) {
       b.gltf["images"] = {{{"bufferView", 77}, {"mimeType", "image/png"}}};
     },
     "77"},
    {"Albedo",
     [](auto& b) {
       b.gltf["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {2, 0, 0, 1};
     },
     "baseColorFactor is outside 0..1"},
    {"EmissionNegative",
     [](auto& b) {
       b.gltf["materials"][0]["emissiveFactor"] = {-1, 0, 0};
     },
     "is outside 0..1e6"},
    {"Rotation",
     [](auto& b) {
       b.gltf["nodes"][0]["rotation"] = {0, 0, 0, 0};
     },
     "rotation is no unit quaternion"},
    {"Translation",
     [](auto& b) {
       b.gltf["nodes"][0]["translation"] = {1, 2};
     },
     "translation has 2 numbers"},
    {"Flattened",
     [](auto& b) {
       b.gltf["nodes"][0]["scale"] = {1, 1, 0};
     },
     "no triangles with an area"},
    {"DeepJson", [](auto& b) { b.gltf["extras"] = nested(100); }, "nests deeper than 64"},
    {"NodesNoList", [](auto& b) { b.gltf["nodes"] = 3; }, "\"nodes\" is no array"},
    {"MaterialNoObject", [](auto& b) { b.gltf["materials"] = {1}; }, "no object"},
    {"ControlCharacters",
     [](auto& b) {
       b.gltf["nodes"][0]["name"] = "a\x1b[2J";
       b.primitive(0)["mode"] = 9;
     },
     "node \"a?[2J\""},
};

TEST_F(SceneBadInput, TheUnspoiltSceneLoads) {
  EXPECT_EQ(error_of_bytes(sound().glb()), "no error");
  EXPECT_EQ(log_.take(), "") << "and there is nothing to complain of";
}

TEST_F(SceneBadInput, EachIsNamed) {
  for (const SpoiltCase& bad : spoilt_cases) {
    SceneBuilder builder = sound();
    bad.spoil(builder);
    const std::string error = error_of_bytes(builder.glb());
    EXPECT_THAT(error, ::testing::HasSubstr(bad.message)) << bad.name;
    EXPECT_THAT(error, ::testing::HasSubstr("scene.glb: ")) << bad.name;
  }
}

TEST_F(SceneBadInput, FilesThatAreNone) {
  const TempFolder folder;
  EXPECT_THAT(error_of(folder.path() / "absent.glb"), ::testing::HasSubstr("absent.glb: no such file"));
  EXPECT_THAT(error_of(folder.path()), ::testing::HasSubstr("not a file"));
  EXPECT_THAT(error_of("/dev/zero"), ::testing::HasSubstr("not a file"));
  EXPECT_THAT(error_of_bytes(""), ::testing::HasSubstr("empty file"));
  EXPECT_THAT(error_of_bytes("glTF"), ::testing::HasSubstr("truncated"));
  EXPECT_THAT(error_of_bytes("hello"), ::testing::HasSubstr("not a glTF file"));
  EXPECT_THAT(error_of_bytes("[]", "scene.gltf"), ::testing::HasSubstr("no object"));
  EXPECT_THAT(error_of_bytes(std::string(1 << 20, '['), "scene.gltf"), ::testing::HasSubstr("nests deeper"));
}

TEST_F(SceneBadInput, EveryTruncationIsAnError) {
  const std::string bytes = sound().glb();
  const TempFolder folder;
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    EXPECT_NE(error_of(folder.write("cut.glb", bytes.substr(0, size))), "no error") << size;
  }
}

TEST_F(SceneBadInput, LyingChunkLengths) {
  const std::string bytes = sound().glb();
  const auto json_bytes = static_cast<std::size_t>(bytes.find("BIN")) - 4;
  for (const std::size_t at : {std::size_t{8}, std::size_t{12}, json_bytes}) {
    std::string lying = bytes;
    lying[at + 2] = '\x7f';
    EXPECT_NE(error_of_bytes(lying), "no error") << at;
  }
  std::string longer = bytes;  // by the 8 bytes of its own header
  longer[json_bytes] = static_cast<char>(longer[json_bytes] + 8);
  EXPECT_THAT(error_of_bytes(longer), ::testing::HasSubstr("chunk 1 is longer than the file"));
  for (char length = 0; length < 20; ++length) {  // of a file that ends before its first chunk, which is long
    std::string shorter = bytes;
    shorter.replace(8, 8, {length, 0, 0, 0, 0, 0, 0, '\x70'});
    EXPECT_THAT(error_of_bytes(shorter), ::testing::HasSubstr("a .glb has at least 20")) << int{length};
  }
}

// What no scene shows is refused by its name, too, and not where somebody follows it.
TEST_F(SceneBadInput, MeshesOfUnseenNodes) {
  SceneBuilder builder = sound();
  builder.gltf["nodes"].push_back({{"name", "unseen"}, {"mesh", 77}});
  EXPECT_THAT(error_of_bytes(builder.glb()), ::testing::HasSubstr("node \"unseen\": there is no mesh 77"));
  builder.gltf["nodes"][1]["mesh"] = 77;
  builder.gltf["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = false;
  EXPECT_THAT(error_of_bytes(builder.glb()), ::testing::HasSubstr("node \"child\": there is no mesh 77"));
}

TEST_F(SceneBadInput, WhereTheReaderGivesNoReasonAProgramIsNamed) {
  SceneBuilder builder = sound();
  builder.gltf["skins"] = {{{"name", "of no joints"}}};
  EXPECT_THAT(error_of_bytes(builder.glb()), ::testing::HasSubstr("the glTF validator"));
}

TEST_F(SceneBadInput, LinksOutOfTheFolderAreNotFollowed) {
  const TempFolder folder, outside;
  outside.write("secret.bin", std::string(4096, 'x'));
  std::filesystem::create_symlink(outside.path() / "secret.bin", folder.path() / "mesh.bin");
  SceneBuilder builder = sound();
  builder.gltf["buffers"] = {{{"byteLength", 4096}, {"uri", "mesh.bin"}}};
  EXPECT_THAT(error_of(folder.write("scene.glb", builder.glb())), ::testing::HasSubstr("File not found"));
}

// Random damage to the shipped scene: either it loads into a consistent scene or it is refused.
TEST_F(SceneBadInput, RandomDamage) {
  std::ifstream in(LICHTVELD_SOURCE_DIR "/assets/cornell.glb", std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  const std::string original = text.str();
  ASSERT_GT(original.size(), 1000u);
  const TempFolder folder;
  std::mt19937 random(1);
  const std::string digits = "0123456789-.eE[]{},:\"";
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(4);
  int loaded = 0, refused = 0;
  for (int round = 0; round < 3000 && std::chrono::steady_clock::now() < end; ++round) {
    std::string bytes = original;
    for (std::size_t hits = 1 + random() % 4; hits > 0; --hits) {
      char& byte = bytes[random() % bytes.size()];
      byte = random() % 2 ? digits[random() % digits.size()] : static_cast<char>(random());
    }
    try {
      const Scene scene = load(folder.write("damaged.glb", bytes));
      for (std::uint32_t index : scene.indices) ASSERT_LT(index, scene.vertices.size());
      for (const Surface& surface : scene.surfaces) ASSERT_LT(surface.material, scene.materials.size());
      ++loaded;
    } catch (const SceneError&) {
      ++refused;
    }
  }
  EXPECT_GT(loaded, 0);
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace lichtveld::scene
