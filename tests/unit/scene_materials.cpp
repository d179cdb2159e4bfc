// What surfaces reflect: textures, where they lie, vertex colours, materials of extensions.
#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>

#include "lichtveld/scene/scene.hpp"
#include "lichtveld/scene/surface_point.hpp"
#include "remarks.hpp"
#include "scene_damage.hpp"
#include "scene_log.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;
using testing::base_colour;
using testing::image_of;
using testing::LogCapture;
using testing::text_of;
using testing::textured;

// Of linear light, of 255 0 0 and 10 20 30.
constexpr glm::vec3 red{1, 0, 0}, dark{0.003035f, 0.006995f, 0.012983f};

// Of a place on the floor, -1..1.
glm::vec3 albedo_of(const Scene& scene, float x, float z) {
  for (std::uint32_t triangle = 0; triangle < scene.indices.size() / 3; ++triangle) {
    const auto corner = [&](std::uint32_t k) {
      const glm::vec3& p = scene.vertices[scene.indices[3 * triangle + k]].position;
      return glm::vec2(p.x, p.z);
    };
    const glm::vec2 a = corner(1) - corner(0), b = corner(2) - corner(0), p = glm::vec2(x, z) - corner(0);
    const float whole = a.x * b.y - a.y * b.x;
    const glm::vec2 at{(p.x * b.y - p.y * b.x) / whole, (a.x * p.y - a.y * p.x) / whole};
    if (at.x >= 0 && at.y >= 0 && at.x + at.y <= 1)
      return albedo_at(scene, scene.materials[scene.surfaces[0].material], {triangle, at});
  }
  throw std::runtime_error("not on the floor");
}

void expect_colour(const glm::vec3& actual, const glm::vec3& expected) {
  EXPECT_LT(glm::distance(actual, expected), 1e-5f) << actual.r << " " << actual.g << " " << actual.b;
}

TEST(SceneMaterials, VertexColoursOfAnyKindAreFactors) {
  const auto with = [](auto colour, int type, const char* kind) {
    SceneBuilder builder = sound();  // of albedo 0.5
    const int accessor = builder.accessor(std::vector(4, colour), type, kind);
    accessor_json(builder, accessor)["normalized"] = type != 5126;
    attributes(builder)["COLOR_0"] = accessor;
    return albedo_of(loaded(builder), 0.1f, 0.3f);
  };
  constexpr glm::vec3 expected{0.5f, 0.1f, 0};
  expect_colour(with(glm::vec3(1, 0.2f, 0), 5126, "VEC3"), expected);
  expect_colour(with(glm::vec4(1, 0.2f, 0, 0.3f), 5126, "VEC4"), expected);
  expect_colour(with(std::array<std::uint8_t, 3>{255, 51, 0}, 5121, "VEC3"), expected);
  expect_colour(with(std::array<std::uint8_t, 4>{255, 51, 0, 7}, 5121, "VEC4"), expected);
  expect_colour(with(std::array<std::uint16_t, 3>{65535, 13107, 0}, 5123, "VEC3"), expected);
  expect_colour(with(std::array<std::uint16_t, 4>{65535, 13107, 0, 7}, 5123, "VEC4"), expected);
  expect_colour(with(glm::vec3(7, 0.2f, -3), 5126, "VEC3"), expected);  // clamped, as glTF has it
}

TEST(SceneMaterials, VertexColoursBlendAndMultiplyTextures) {
  SceneBuilder builder = textured();
  builder.primitive(0)["attributes"]["COLOR_0"] =
      builder.accessor(std::vector<glm::vec3>{{0, 1, 1}, {1, 1, 1}, {1, 1, 1}, {0, 1, 1}}, 5126, "VEC3");
  expect_colour(albedo_of(loaded(builder), -0.5f, 0), 0.25f * red);
}

TEST(SceneMaterials, BadVertexColoursAreRefused) {
  SceneBuilder builder = sound();
  attributes(builder)["COLOR_0"] = builder.accessor(std::vector<glm::vec3>(4), 5126, "VEC3");
  expect_refused(
      builder,
      {{"Few", [](auto& b) { accessor_json(b, 3)["count"] = 3; }, "COLOR_0 has fewer elements"},
       {"Nan", [](auto& b) { overwrite(b, 3, 0, std::nanf("")); }, "COLOR_0 of vertex 0 is not finite"},
       {"Flat", [](auto& b) { attributes(b)["COLOR_0"] = 1; }, "COLOR_0 (accessor 1): expected VEC4"},
       {"Absent", [](auto& b) { attributes(b)["COLOR_0"] = 99; }, "there is no accessor 99"}});
}

// The floor's albedo at a place with a KHR_texture_transform.
glm::vec3 transformed(const json& transform, float x, float z) {
  SceneBuilder builder = textured();
  base_colour(builder)["baseColorTexture"]["extensions"]["KHR_texture_transform"] = transform;
  builder.gltf["extensionsRequired"] = {"KHR_texture_transform"};
  return albedo_of(loaded(builder), x, z);
}

TEST(SceneMaterials, TexturesAreTransformed) {
  expect_colour(transformed(json::object(), -0.5f, 0), red);
  expect_colour(transformed(json::object(), 0.5f, 0), dark);
  expect_colour(transformed({{"offset", {0.5, 0}}}, -0.5f, 0), dark);
  expect_colour(transformed({{"offset", {0.25, 0.7}}, {"scale", {0, 0}}}, 0.3f, 0.4f), red);
  expect_colour(transformed({{"offset", {-0.25, 0}}, {"scale", {2, 1}}}, -0.5f, 0), red);
  expect_colour(transformed({{"offset", {-0.25, 0}}, {"scale", {2, 1}}}, 0, 0), dark);
  // A quarter turn counter-clockwise with v down takes (u, v) to (v, -u).
  const double quarter = std::numbers::pi / 2;
  expect_colour(transformed({{"rotation", quarter}}, 0, -0.5f), red);  // v = 0.25
  expect_colour(transformed({{"rotation", quarter}}, 0, 0.5f), dark);
  expect_colour(transformed({{"rotation", -quarter}}, 0, -0.5f), dark);
  // Scaled first, then turned: u = 3 v.
  expect_colour(transformed({{"rotation", quarter}, {"scale", {1, 3}}}, 0, -0.5f), dark);
}

TEST(SceneMaterials, QuantisedCoordinatesAreScaledBack) {
  SceneBuilder builder = textured();
  attributes(builder)["TEXCOORD_0"] = builder.accessor(
      std::vector<std::array<std::int16_t, 2>>{{-400, 0}, {400, 0}, {400, 0}, {-400, 0}}, 5122, "VEC2");
  base_colour(builder)["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
      {"scale", {1.0 / 800, 1.0 / 800}}, {"offset", {0.5, 0.5}}};
  const Scene scene = loaded(builder);
  expect_colour(albedo_of(scene, -0.5f, 0), red);
  expect_colour(albedo_of(scene, 0.5f, 0), dark);
}

TEST(SceneMaterials, AnyTexcoordSetIsRead) {
  SceneBuilder builder = textured();
  attributes(builder)["TEXCOORD_3"] = builder.accessor(std::vector<glm::vec2>(4, {0.75f, 0.5f}), 5126, "VEC2");
  auto& texture = base_colour(builder)["baseColorTexture"];
  texture["texCoord"] = 3;
  expect_colour(albedo_of(loaded(builder), -0.5f, 0), dark);
  texture["texCoord"] = 1;
  texture["extensions"]["KHR_texture_transform"]["texCoord"] = 3;
  expect_colour(albedo_of(loaded(builder), -0.5f, 0), dark);
}

TEST(SceneMaterials, ATextureWithoutItsTexcoordIsItsCorner) {
  LogCapture log;
  SceneBuilder builder = textured();
  attributes(builder).erase("TEXCOORD_0");
  base_colour(builder)["baseColorTexture"]["extensions"]["KHR_texture_transform"]["offset"] = {0.75, 0};
  expect_colour(albedo_of(loaded(builder), -0.5f, 0), dark);
  EXPECT_THAT(log.take(), ::testing::HasSubstr("primitive 0: has no TEXCOORD_0 for its texture"));
}

TEST(SceneMaterials, TexturesRepeatMirrorOrEnd) {
  const auto at = [](int mode, double u) {
    SceneBuilder builder = textured();
    builder.gltf["samplers"] = {{{"wrapS", mode}, {"wrapT", mode}}};
    builder.gltf["textures"][0]["sampler"] = 0;
    base_colour(builder)["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {{"scale", {0, 0}},
                                                                                       {"offset", {u, 9.5}}};
    return albedo_of(loaded(builder), 0, 0);
  };
  constexpr int repeat = 10497, mirror = 33648, clamp = 33071;
  expect_colour(at(repeat, 5.25), red);
  expect_colour(at(repeat, -0.25), dark);
  expect_colour(at(repeat, 0), (red + dark) / 2.0f);
  expect_colour(at(mirror, 5.25), dark);
  expect_colour(at(mirror, -0.25), red);
  expect_colour(at(mirror, -1.25), dark);
  expect_colour(at(mirror, 2), red);
  expect_colour(at(mirror, 1.1), dark);
  expect_colour(at(clamp, 5.25), dark);
  expect_colour(at(clamp, -0.25), red);
  expect_colour(at(clamp, 1e30), dark);
}

TEST(SceneMaterials, BadTexturesAreRefused) {
  const auto transform = [](SceneBuilder& b) -> json& {
    return base_colour(b)["baseColorTexture"]["extensions"]["KHR_texture_transform"];
  };
  expect_refused(
      textured(),
      {{"Offset", [&](auto& b) { transform(b)["offset"] = {1}; }, "offset is no pair of numbers"},
       {"Scale", [&](auto& b) { transform(b)["scale"] = "big"; }, "KHR_texture_transform: scale is no pair"},
       {"Rotation", [&](auto& b) { transform(b)["rotation"] = "left"; }, "rotation is no number"},
       {"Set", [&](auto& b) { transform(b)["texCoord"] = -1; }, "negative texCoord"},
       {"SetKind", [&](auto& b) { transform(b)["texCoord"] = "one"; }, "texCoord is no whole number"},
       {"Far",
        [&](auto& b) {
          transform(b)["offset"] = {1e300, 0};
        },
        "of vertex 0 is not finite"},
       // What lies between such and their like is no number.
       {"AtTheEnd", [](auto& b) { overwrite(b, attributes(b)["TEXCOORD_0"].template get<std::size_t>(), 1, 3e38f); },
        "of vertex 0 is not finite or beyond 1e30"},
       {"Sampler", [](auto& b) { b.gltf["textures"][0]["sampler"] = 7; }, "there is no sampler 7"},
       {"Wrap",
        [](auto& b) {
          b.gltf["textures"][0]["sampler"] = 0;
          b.gltf["samplers"] = {{{"wrapS", 5}}};
        },
        "sampler 0 has the unknown wrap mode 5"}});
}

TEST(SceneMaterials, WebpTexturesAreRead) {
  for (const bool alpha : {false, true}) {
    SceneBuilder builder = textured();
    builder.gltf["images"] = {
        image_of(builder, alpha ? text_of(testing::webp_with_alpha) : text_of(testing::webp))};
    builder.gltf["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
    builder.gltf["extensionsRequired"] = {"EXT_texture_webp"};
    const Scene scene = loaded(builder);
    ASSERT_EQ(scene.textures.size(), 1u);
    const std::uint8_t first = alpha ? 0 : 255, second = alpha ? 128 : 255;
    EXPECT_EQ(scene.textures[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, first, 10, 20, 30, second}));
  }
}

TEST(SceneMaterials, DataUrisAreOfAnyType) {
  for (const char* type : {"image/webp", "image/jpg", ""}) {
    SceneBuilder builder = textured();
    builder.gltf["images"] = {
        {{"uri",
          std::string("data:") + type + ";base64,UklGRiAAAABXRUJQVlA4TBQAAAAvAQAAAA8wFF/4H4/5Dy1UIKL/AQ=="}}};
    EXPECT_EQ(loaded(builder).textures[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 10, 20, 30, 255}))
        << type;
  }
}

TEST(SceneMaterials, AFallbackIsTaken) {
  for (const char* extension : {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif"}) {
    SceneBuilder builder = textured();
    builder.gltf["images"].push_back(image_of(builder, "no picture"));
    builder.gltf["textures"][0]["extensions"][extension]["source"] = 1;
    EXPECT_EQ(loaded(builder).textures.size(), 1u) << extension;
  }
}

TEST(SceneMaterials, OtherFormatsAreRefusedWithACommand) {
  const auto alone = [](const char* extension, const std::string& bytes) {
    return [=](SceneBuilder& b) {
      b.gltf["images"] = {image_of(b, bytes)};
      b.gltf["textures"] = {{{"extensions", {{extension, {{"source", 0}}}}}}};
    };
  };
  std::string huge = text_of(testing::webp);
  huge.replace(21, 4, "\xff\xff\xff\x0f");  // 16384 x 16384
  expect_refused(textured(),
                 {{"Basisu", alone("KHR_texture_basisu", "?"),
                   "texture 0 is there by KHR_texture_basisu alone, which is not read; convert it with npx "
                   "@gltf-transform/cli ktxdecompress in.glb out.glb"},
                  {"Avif", alone("EXT_texture_avif", "?"), "@gltf-transform/cli png in.glb"},
                  {"Ktx", [](auto& b) { b.gltf["images"] = {image_of(b, "\xabKTX 20\xbb\r\n")}; },
                   "image 0 is a KTX2, which is not read; convert it with"},
                  {"NoSource",
                   [](auto& b) {
                     b.gltf["textures"] = {{{"extensions", {{"EXT_texture_webp", json::object()}}}}};
                   },
                   "EXT_texture_webp has no source"},
                  {"Outside",
                   [](auto& b) {
                     b.gltf["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 5}}}}}}};
                   },
                   "has no image 5"},
                  {"Garbage", alone("EXT_texture_webp", "?"), "is no PNG, JPEG or WebP"},
                  {"Cut", alone("EXT_texture_webp", text_of(testing::webp).substr(0, 30)), "does not decode"},
                  {"Huge", alone("EXT_texture_webp", huge), "too large"}});
}

TEST(SceneMaterials, SpecularGlossinessHasItsOwnColour) {
  SceneBuilder builder = textured();
  auto& material = builder.gltf["materials"][0];
  material.erase("pbrMetallicRoughness");
  auto& gloss = material["extensions"]["KHR_materials_pbrSpecularGlossiness"];
  gloss["diffuseFactor"] = {0.5, 0.25, 1, 1};
  expect_colour(albedo_of(loaded(builder), -0.5f, 0), {0.5f, 0.25f, 1});
  gloss["diffuseTexture"] = {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}}}};
  expect_colour(albedo_of(loaded(builder), -0.5f, 0), glm::vec3(0.5f, 0.25f, 1) * dark);
  expect_refused(
      builder,
      {{"Few",
        [](auto& b) {
          b.gltf["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"]["diffuseFactor"] = {1};
        },
        "diffuseFactor has no four numbers"},
       {"Kind",
        [](auto& b) {
          b.gltf["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"]["diffuseTexture"] = 0;
        },
        "diffuseTexture has no index"}});
}

TEST(SceneMaterials, TheSameOfManyIsOneLine) {
  LogCapture log;
  Remarks remarks;
  for (int i = 0; i < 20; ++i) remarks.add("is odd", "material " + std::to_string(i));
  remarks.tell("a.glb");
  const std::string lines = log.take();
  EXPECT_THAT(lines, ::testing::HasSubstr("a.glb: material 0 and 19 more: is odd"));
  EXPECT_EQ(std::ranges::count(lines, '\n'), 1) << lines;
}

}  // namespace
}  // namespace lichtveld::scene
