#include "seeds.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstring>
#include <stdexcept>

#include "hdr.hpp"
#include "scene_compressed.hpp"
#include "scene_features.hpp"

namespace lichtveld::mutants {
namespace {

using namespace lichtveld::testing;
using nlohmann::json;

std::string base64(const std::string& bytes) {
  constexpr const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? letters[three >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

// 16 x 8 pixels, brighter on top.
std::string exr_sky() {
  constexpr int width = 16, height = 8;
  std::vector<float> pixels;
  for (int row = 0; row < height; ++row)
    pixels.insert(pixels.end(), 3 * width, static_cast<float>(height - row));
  std::vector<std::uint8_t> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto out = OIIO::ImageOutput::create("sky.exr", &memory);
  if (!out || !out->open("sky.exr", OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::FLOAT)) ||
      !out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) || !out->close())
    throw std::runtime_error("no EXR of a sky can be made");
  return {bytes.begin(), bytes.end()};
}

// A lamp above the floor and a crate on it, so that there are shadows, reflections and, as `doubled` says,
// charts of the file's own that overlap.
void furnish(SceneBuilder& builder, bool doubled = false) {
  const int glow = builder.material(glm::vec3(0.2f), glm::vec3(3, 4, 5)),
            grey = builder.material(glm::vec3(0.6f));
  builder.quad("lamp", {glm::vec3{-0.5f, 2, -0.5f}, {0.5f, 2, -0.5f}, {0.5f, 2, 0.5f}, {-0.5f, 2, 0.5f}},
               {0.91f, 0, 1, 0.09f}, glow);
  const Chart chart = doubled ? Chart{0.2f, 0.2f, 0.8f, 0.8f} : Chart{0, 0.91f, 0.8f, 1};
  builder.box("crate", {-0.4f, 0, -0.3f}, {0.2f, 0.5f, 0.3f}, chart, grey);
}

Parts as_glb(SceneBuilder builder) {
  if (!builder.gltf.contains("buffers")) {
    builder.bin.resize((builder.bin.size() + 3) / 4 * 4);
    builder.gltf["buffers"] = {{{"byteLength", builder.bin.size()}}};
  }
  return {"scene.glb", builder.gltf, builder.bin, {}};
}

Parts furnished(SceneBuilder builder) {
  furnish(builder);
  return as_glb(std::move(builder));
}

// With its buffer and its picture in files of their own.
Parts with_side_files() {
  SceneBuilder builder = textured();
  builder.gltf["images"] = {{{"uri", "picture.png"}}};
  Parts parts = furnished(builder);
  parts.name = "scene.gltf";
  parts.gltf["buffers"][0]["uri"] = "mesh.bin";
  parts.beside = {{"mesh.bin", parts.bin}, {"picture.png", text_of(png)}};
  parts.bin.clear();
  return parts;
}

Parts embedded() {
  Parts parts = furnished(sound());
  parts.name = "scene.gltf";
  parts.gltf["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(parts.bin);
  parts.bin.clear();
  return parts;
}

Parts sparse() {
  SceneBuilder builder = sound();
  make_sparse(builder, 0, std::vector<std::uint16_t>{0, 2}, std::vector<glm::vec3>{{-1, 0, 1}, {1, 0.2f, -1}});
  make_sparse(builder, 1, std::vector<std::uint32_t>{3}, std::vector<glm::vec2>{{0.2f, 0.3f}});
  make_sparse(builder, 2, std::vector<std::uint8_t>{1, 2}, std::vector<std::uint16_t>{1, 2});
  const int normals = vectors(builder, std::vector<glm::vec3>(4, {0, 1, 0}));
  make_sparse(builder, normals, std::vector<std::uint8_t>{0, 1, 2, 3},
              std::vector<glm::vec3>(4, glm::vec3{0, 5, 0}));
  accessor_json(builder, normals).erase("bufferView");
  attributes(builder)["NORMAL"] = normals;
  return furnished(builder);
}

Parts meshopted() {
  SceneBuilder builder = filtered_by_meshopt();
  furnish(builder);
  add_buffers(builder);
  return as_glb(builder);
}

Parts dracoed(draco::MeshEncoderMethod method) {
  return furnished(packed_by_draco(encoded_floor(method)));
}

Parts webp_on_any_texcoord() {
  SceneBuilder builder = textured();
  builder.gltf["images"] = {image_of(builder, text_of(webp_with_alpha))};
  builder.gltf["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
  builder.gltf["extensionsRequired"] = {"EXT_texture_webp"};
  attributes(builder)["TEXCOORD_3"] = builder.accessor(
      std::vector<std::array<std::uint16_t, 2>>{{0, 65535}, {65535, 65535}, {65535, 0}, {}}, 5123, "VEC2");
  accessor_json(builder, attributes(builder)["TEXCOORD_3"].get<int>())["normalized"] = true;
  base_colour(builder)["baseColorTexture"]["texCoord"] = 3;
  return furnished(builder);
}

Parts transformed() {
  SceneBuilder builder = textured();
  base_colour(builder)["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
      {"offset", {0.25, 0.5}}, {"scale", {2, 3}}, {"rotation", 0.7}, {"texCoord", 0}};
  builder.gltf["extensionsRequired"] = {"KHR_texture_transform"};
  builder.gltf["samplers"] = {{{"wrapS", 33648}, {"wrapT", 33071}}};
  builder.gltf["textures"][0]["sampler"] = 0;
  return furnished(builder);
}

Parts coloured() {
  SceneBuilder builder = sound();
  attributes(builder)["COLOR_0"] = builder.accessor(
      std::vector<glm::vec4>{{1, 0.2f, 0, 1}, {0, 1, 1, 0.5f}, {1, 1, 1, 1}, {0, 0, 0, 1}}, 5126, "VEC4");
  return furnished(builder);
}

// Textures that say where a surface is and where it shines.
Parts cut(const json& alpha, bool emission) {
  SceneBuilder builder = textured();
  builder.gltf["images"] = {image_of(builder, text_of(webp_with_alpha))};
  auto& material = builder.gltf["materials"][0];
  material.update(alpha);
  if (emission) material["emissiveTexture"] = {{"index", 0}};
  return furnished(builder);
}

Parts transmitting() {
  SceneBuilder builder = textured();
  builder.gltf["materials"][0]["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 0.6}};
  return furnished(builder);
}

Parts glossy() {
  SceneBuilder builder = textured();
  auto& material = builder.gltf["materials"][0];
  material.erase("pbrMetallicRoughness");
  material["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {
      {"diffuseFactor", {0.5, 0.25, 1, 1}},
      {"diffuseTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}}}}}};
  return furnished(builder);
}

Parts unlit() {
  SceneBuilder builder = textured();
  builder.gltf["materials"][0]["extensions"]["KHR_materials_unlit"] = json::object();
  return furnished(builder);
}

Parts instances() {
  SceneBuilder builder = instanced();
  auto& of = builder.node(0)["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  const int rotation =
      builder.accessor(std::vector(3, std::array<std::int16_t, 4>{0, 32767, 0, 0}), 5122, "VEC4");
  accessor_json(builder, rotation)["normalized"] = true;
  of["ROTATION"] = rotation;
  of["SCALE"] = vectors(builder, {{1, 1, 1}, {1, 1, 1}, {2, 1, 1}});
  return furnished(builder);
}

Parts morphed() {
  SceneBuilder builder = morphing();
  builder.node(0)["weights"] = {0.5, 0.25};
  return furnished(builder);
}

Parts without_scenes() {
  Parts parts = furnished(sound());
  parts.gltf.erase("scene");
  parts.gltf.erase("scenes");
  return parts;
}

SceneBuilder with_lights() {
  SceneBuilder builder = sound();
  furnish(builder);
  builder.gltf["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 10}, {"range", 20}, {"extras", {{"radius", 0.1}}}},
      {{"type", "spot"}, {"intensity", 10}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 1.0}}}},
      {{"type", "directional"}, {"intensity", 3}, {"color", {1, 0.5, 0}}, {"extras", {{"angle", 0.53}}}}};
  for (int light = 0; light < 3; ++light) {
    auto& nodes = builder.gltf["nodes"];
    nodes.push_back({{"name", "light " + std::to_string(light)},
                     {"translation", {0.3, 1.5, 0.1 * light}},
                     {"rotation", {-0.70710678, 0, 0, 0.70710678}},
                     {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    builder.gltf["scenes"][0]["nodes"].push_back(nodes.size() - 1);
  }
  return builder;
}

Parts image_based() {
  SceneBuilder builder = sound();
  json coefficients(9, {0.1, 0.2, 0.3});
  coefficients[0] = {3, 2, 1};
  builder.gltf["extensions"]["EXT_lights_image_based"]["lights"] = {
      {{"intensity", 2}, {"rotation", {0, 0, 0, 1}}, {"irradianceCoefficients", coefficients}}};
  builder.gltf["extensionsRequired"] = {"EXT_lights_image_based"};
  builder.gltf["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  return furnished(builder);
}

Parts under_a_sky(const std::string& name, const std::string& bytes) {
  SceneBuilder builder = sound();
  builder.gltf["scenes"][0]["extras"] = {{"sky", name}, {"switchable", true}};
  Parts parts = furnished(builder);
  parts.beside[name] = bytes;
  return parts;
}

std::string hdr_sky() {
  return hdr(64, 32, [](int column, int row) {
    return column >= 20 && column < 22 && row == 8 ? glm::vec3(8000, 7000, 6000) : glm::vec3(1, 2, 3);
  });
}

Parts that_switches() {
  SceneBuilder builder = with_lights();
  builder.node(2)["extras"] = {{"switchable", true}};  // the lamp
  builder.node(3)["extras"] = {{"movable", true}};     // the crate
  builder.node(4)["extras"] = {{"flicker", 0.4}};
  builder.node(5)["extras"] = {{"schedule", 4}};
  builder.node(6)["extras"] = {{"switchable", true}, {"movable", true}, {"flicker", 0.1}};
  return as_glb(builder);
}

Parts partly_hidden() {
  SceneBuilder builder = with_lights();
  builder.node(1)["extensions"]["KHR_node_visibility"]["visible"] = false;
  builder.node(4)["extensions"]["KHR_node_visibility"]["visible"] = false;
  builder.node(5)["extensions"]["KHR_node_visibility"]["visible"] = true;
  builder.gltf["extensionsRequired"] = {"KHR_node_visibility"};
  return as_glb(builder);
}

// Some without TEXCOORD_1, a double-sided one among them. What no scene shows is carried into the file that is
// written: a mesh, an animation, a skin, a picture.
Parts to_unwrap() {
  SceneBuilder builder = skinned();
  builder.node(0).erase("skin");
  furnish(builder);
  builder.gltf["materials"][0]["doubleSided"] = true;
  for (const int node : {0, 4}) builder.primitive(node)["attributes"].erase("TEXCOORD_1");
  builder.gltf["nodes"].push_back({{"name", "unseen"}, {"mesh", 2}, {"skin", 0}});
  builder.quad("unseen too", {glm::vec3{-1, 3, 1}, {1, 3, 1}, {1, 3, -1}, {-1, 3, -1}}, {0, 0, 1, 1}, 0);
  builder.gltf["scenes"][0]["nodes"].erase(builder.gltf["scenes"][0]["nodes"].size() - 1);
  const int times = builder.accessor(std::vector<float>{0, 1}, 5126, "SCALAR"),
            places = vectors(builder, {{0, 0, 0}, {0, 0, 0}});
  accessor_json(builder, places).erase("bufferView");
  builder.gltf["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
       {"samplers", {{{"input", times}, {"output", places}}}}}};
  builder.gltf["images"] = {image_of(builder, text_of(png))};
  return as_glb(builder);
}

Parts overlapping() {
  SceneBuilder builder = sound();
  furnish(builder, true);
  return as_glb(builder);
}

}  // namespace

const std::vector<std::string>& raw_texts() {
  static const std::vector<std::string> texts = {
      "NaN", "Infinity", "1e999",        "-1e999",      "1e-999",        "00",          "+1", "0x10",
      "1.",  "-0",       "\"\xff\xfe\"", "\"\\ud800\"", "\"a\\u0000b\"", "\"\x1b[2J\"", "nul"};
  return texts;
}

std::vector<Seed> seeds() {
  return {{"plain", furnished(sound())},
          {"side_files", with_side_files()},
          {"embedded", embedded()},
          {"sparse", sparse()},
          {"quantised", furnished(quantised())},
          {"meshopt", meshopted()},
          {"draco", dracoed(draco::MESH_EDGEBREAKER_ENCODING)},
          {"draco_sequential", dracoed(draco::MESH_SEQUENTIAL_ENCODING)},
          {"webp_texcoord_3", webp_on_any_texcoord()},
          {"texture_transform", transformed()},
          {"vertex_colours", coloured()},
          {"emissive_texture", cut(json::object(), true)},
          {"alpha_mask", cut({{"alphaMode", "MASK"}, {"alphaCutoff", 0.4}}, true)},
          {"alpha_blend", cut({{"alphaMode", "BLEND"}, {"doubleSided", true}}, false)},
          {"transmission", transmitting()},
          {"specular_glossiness", glossy()},
          {"unlit", unlit()},
          {"instances", instances()},
          {"skin", furnished(skinned())},
          {"morph", morphed()},
          {"no_scenes", without_scenes()},
          {"lights", as_glb(with_lights())},
          {"image_based", image_based()},
          {"sky_hdr", under_a_sky("sky.hdr", hdr_sky())},
          {"sky_exr", under_a_sky("sky.exr", exr_sky())},
          {"switches", that_switches()},
          {"hidden", partly_hidden()},
          {"unwrapped", to_unwrap()},
          {"overlapping", overlapping()}};
}

std::string written(const Parts& parts) {
  std::string text = parts.gltf.dump();
  for (std::size_t at = 0; (at = text.find(std::string(1, '"') + raw_mark, at)) != std::string::npos;) {
    const std::size_t end = text.find('"', at + 1), number = at + 1 + std::strlen(raw_mark);
    const std::string& raw = raw_texts().at(std::stoul(text.substr(number, end - number)));
    text.replace(at, end + 1 - at, raw);
    at += raw.size();
  }
  if (!parts.name.ends_with(".glb")) return text;
  const auto word = [](std::size_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(value >> (8 * i)));
    return bytes;
  };
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string chunk = parts.bin;
  chunk.resize((chunk.size() + 3) / 4 * 4);
  return "glTF" + word(2) + word(28 + text.size() + chunk.size()) + word(text.size()) + "JSON" + text +
         word(chunk.size()) + std::string("BIN\0", 4) + chunk;
}

}  // namespace lichtveld::mutants
