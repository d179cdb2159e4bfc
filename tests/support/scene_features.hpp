// A sound scene, and the same with what exporters write: sparse and quantised accessors, textures, compressed
// geometry, morph targets, skins, instances. Accessors of sound(): 0 POSITION, 1 TEXCOORD_1, 2 indices.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "scene_builder.hpp"
#include "scene_pictures.hpp"

namespace lichtveld::testing {

// A floor and a child node.
inline SceneBuilder sound() {
  SceneBuilder builder;
  builder.quad("floor", {glm::vec3{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}, {0.1f, 0.1f, 0.9f, 0.9f},
               builder.material({0.5f, 0.5f, 0.5f}, {1, 1, 1}));
  builder.gltf["nodes"].push_back({{"name", "child"}});
  builder.gltf["nodes"][0]["children"] = {1};
  return builder;
}

inline nlohmann::json& accessor_json(SceneBuilder& builder, int accessor) {
  return builder.gltf["accessors"][static_cast<std::size_t>(accessor)];
}

inline nlohmann::json& attributes(SceneBuilder& b) {
  return b.primitive(0)["attributes"];
}

inline nlohmann::json& base_colour(SceneBuilder& b) {
  return b.gltf["materials"][0]["pbrMetallicRoughness"];
}

inline int view_of(SceneBuilder& builder, int accessor) {
  return accessor_json(builder, accessor)["bufferView"].get<int>();
}

inline int vectors(SceneBuilder& builder, const std::vector<glm::vec3>& elements) {
  return builder.accessor(elements, 5126, "VEC3");
}

template <typename T>
void overwrite(SceneBuilder& builder, std::size_t accessor, std::size_t element, T value) {
  const nlohmann::json& view =
      builder.gltf["bufferViews"][builder.gltf["accessors"][accessor]["bufferView"].get<std::size_t>()];
  std::memcpy(&builder.bin.at(view["byteOffset"].get<std::size_t>() + element * sizeof value), &value,
              sizeof value);
}

// Elements `indices` of an accessor get `values`.
template <typename Index, typename Value>
void make_sparse(SceneBuilder& builder, int accessor, const std::vector<Index>& indices,
                 const std::vector<Value>& values) {
  const int at = view_of(builder, builder.accessor(indices, 5121, "SCALAR"));
  const int what = view_of(builder, builder.accessor(values, 5121, "SCALAR"));
  const int type = sizeof(Index) == 1 ? 5121 : sizeof(Index) == 2 ? 5123 : 5125;
  accessor_json(builder, accessor)["sparse"] = {{"count", indices.size()},
                                                {"indices", {{"bufferView", at}, {"componentType", type}}},
                                                {"values", {{"bufferView", what}}}};
}

// Attributes of the floor in whole numbers.
template <typename T>
int whole_numbers(SceneBuilder& builder, const std::vector<T>& elements, int type, const char* kind,
                  bool normalised) {
  const int accessor = builder.accessor(elements, type, kind);
  accessor_json(builder, accessor)["normalized"] = normalised;
  return accessor;
}

// The floor in shorts of a centimetre, its normals in bytes.
inline SceneBuilder quantised(const char* key = "extensionsRequired") {
  SceneBuilder builder = sound();
  builder.gltf[key] = {"KHR_mesh_quantization"};
  using Shorts = std::array<std::int16_t, 4>;  // of which three count, to be aligned
  const int positions = whole_numbers(
      builder, std::vector<Shorts>{{-100, 0, 100}, {100, 0, 100}, {100, 0, -100}, {-100, 0, -100}}, 5122,
      "VEC3", false);
  builder.gltf["bufferViews"][static_cast<std::size_t>(view_of(builder, positions))]["byteStride"] = 8;
  attributes(builder)["POSITION"] = positions;
  using Bytes = std::array<std::int8_t, 4>;
  const int normals = whole_numbers(builder, std::vector<Bytes>(4, {0, 127, -128}), 5120, "VEC3", true);
  builder.gltf["bufferViews"][static_cast<std::size_t>(view_of(builder, normals))]["byteStride"] = 4;
  attributes(builder)["NORMAL"] = normals;
  builder.node(0)["scale"] = {0.01, 0.01, 0.01};
  return builder;
}

inline nlohmann::json image_of(SceneBuilder& builder, const std::string& bytes) {
  const int accessor = builder.accessor(std::vector<char>(bytes.begin(), bytes.end()), 5121, "SCALAR");
  return {{"bufferView", accessor_json(builder, accessor)["bufferView"]}};
}

// sound() with a white material and a picture of two pixels on TEXCOORD_0, which is 0..1 over the floor: u runs
// along x, v along z.
inline SceneBuilder textured() {
  SceneBuilder builder = sound();
  base_colour(builder) = {{"baseColorTexture", {{"index", 0}}}};
  builder.gltf["images"] = {image_of(builder, text_of(png))};
  builder.gltf["textures"] = {{{"source", 0}}};
  attributes(builder)["TEXCOORD_0"] =
      builder.accessor(std::vector<glm::vec2>{{0, 1}, {1, 1}, {1, 0}, {0, 0}}, 5126, "VEC2");
  return builder;
}

// The floor, smooth, with two targets: one lifts it by 1 m, the other moves it by 2 m along x and tilts
// normals.
inline SceneBuilder morphing() {
  SceneBuilder builder = sound();
  const std::vector<glm::vec3> up(4, {0, 1, 0});
  attributes(builder)["NORMAL"] = vectors(builder, up);
  builder.primitive(0)["targets"] = {{{"POSITION", vectors(builder, up)}},
                                     {{"POSITION", vectors(builder, std::vector<glm::vec3>(4, {2, 0, 0}))},
                                      {"NORMAL", vectors(builder, std::vector<glm::vec3>(4, {1, 0, 0}))}}};
  return builder;
}

// The floor hangs on two joints: those of -x on "left", of +x on "right", 1 m right of it.
inline SceneBuilder skinned(bool bound = true) {
  SceneBuilder builder = sound();
  attributes(builder)["NORMAL"] = vectors(builder, std::vector<glm::vec3>(4, {0, 1, 0}));
  attributes(builder)["JOINTS_0"] = builder.accessor(
      std::vector<std::array<std::uint8_t, 4>>{{0, 0, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 0}}, 5121,
      "VEC4");
  attributes(builder)["WEIGHTS_0"] = builder.accessor(std::vector<glm::vec4>(4, {1, 0, 0, 0}), 5126, "VEC4");
  auto& nodes = builder.gltf["nodes"];
  nodes.push_back({{"name", "left"}, {"children", {3}}});
  nodes.push_back({{"name", "right"}, {"translation", {1, 0, 0}}});
  builder.gltf["scenes"][0]["nodes"].push_back(2);
  builder.gltf["skins"] = {{{"joints", {2, 3}}}};
  if (bound) {
    const std::vector<glm::mat4> inverse = {glm::mat4(1),
                                            glm::mat4({1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {-1, 0, 0, 1})};
    builder.gltf["skins"][0]["inverseBindMatrices"] = builder.accessor(inverse, 5126, "MAT4");
  }
  builder.node(0)["skin"] = 0;
  builder.node(0)["translation"] = {50, 60, 70};  // of a skinned node nobody asks
  return builder;
}

// The floor three times, 0, 3 and 6 m along x.
inline SceneBuilder instanced() {
  SceneBuilder builder = sound();
  builder.gltf["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  builder.node(0)["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", vectors(builder, {{0, 0, 0}, {3, 0, 0}, {6, 0, 0}})}};
  return builder;
}

}  // namespace lichtveld::testing
