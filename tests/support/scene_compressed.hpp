// sound() with its geometry compressed, by meshoptimizer and by Draco.
#pragma once

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "scene_features.hpp"

namespace lichtveld::testing {

constexpr const char* meshopt = "EXT_meshopt_compression";
constexpr const char* draco_extension = "KHR_draco_mesh_compression";

inline nlohmann::json& view_json(SceneBuilder& b, int accessor) {
  return b.gltf["bufferViews"][static_cast<std::size_t>(view_of(b, accessor))];
}

// Puts bytes into the file and gives the number of their view.
inline std::size_t add_bytes(SceneBuilder& builder, const std::vector<unsigned char>& bytes) {
  return static_cast<std::size_t>(view_of(builder, builder.accessor(bytes, 5121, "SCALAR")));
}

// Compresses what an accessor has, and takes its own bytes away.
inline void pack(SceneBuilder& builder, int accessor, const std::vector<unsigned char>& bytes, const char* mode,
                 std::size_t count, std::size_t stride, const char* filter = nullptr) {
  const std::size_t packed = add_bytes(builder, bytes);
  nlohmann::json extension = builder.gltf["bufferViews"][packed];
  extension.update({{"mode", mode}, {"count", count}, {"byteStride", stride}});
  if (filter) extension["filter"] = filter;
  nlohmann::json& view = view_json(builder, accessor);
  view["extensions"][meshopt] = extension;
  view["buffer"] = 1;
  view["byteOffset"] = 0;
}

template <typename Element>
std::vector<unsigned char> encoded_vertices(const std::vector<Element>& elements) {
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(elements.size(), sizeof(Element)));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), elements.data(), elements.size(),
                                          sizeof(Element)));
  return bytes;
}

inline const std::vector<unsigned int> corners = {0, 1, 2, 0, 2, 3};

// With everything in its fallback buffer, which has no bytes; TRIANGLES for its indices.
inline SceneBuilder packed_by_meshopt() {
  SceneBuilder builder = sound();
  pack(builder, 0, encoded_vertices<glm::vec3>({{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}), "ATTRIBUTES",
       4, 12);
  pack(builder, 1, encoded_vertices<glm::vec2>({{0.1f, 0.9f}, {0.9f, 0.9f}, {0.9f, 0.1f}, {0.1f, 0.1f}}),
       "ATTRIBUTES", 4, 8);
  std::vector<unsigned char> indices(meshopt_encodeIndexBufferBound(6, 4));
  indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), corners.data(), 6));
  pack(builder, 2, indices, "TRIANGLES", 6, 2);
  builder.gltf["extensionsRequired"] = {meshopt};
  return builder;
}

// packed_by_meshopt() through two of its filters: positions EXPONENTIAL, normals OCTAHEDRAL.
inline SceneBuilder filtered_by_meshopt() {
  SceneBuilder builder = packed_by_meshopt();
  const std::vector<glm::vec4> up(4, {0, 1, 0, 0});
  std::vector<std::array<std::int8_t, 4>> octahedral(4);
  meshopt_encodeFilterOct(octahedral.data(), 4, 4, 8, &up[0].x);
  const int normals = builder.accessor(octahedral, 5120, "VEC3");
  accessor_json(builder, normals)["normalized"] = true;
  attributes(builder)["NORMAL"] = normals;
  pack(builder, normals, encoded_vertices(octahedral), "ATTRIBUTES", 4, 4, "OCTAHEDRAL");
  view_json(builder, normals)["byteStride"] = 4;

  const std::vector<glm::vec3> places = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
  std::vector<std::array<std::uint32_t, 3>> exponential(4);
  meshopt_encodeFilterExp(exponential.data(), 4, 12, 15, &places[0].x);
  pack(builder, 0, encoded_vertices(exponential), "ATTRIBUTES", 4, 12, "EXPONENTIAL");
  return builder;
}

// The buffers, as late as the file's bytes are all there.
inline void add_buffers(SceneBuilder& builder) {
  while (builder.bin.size() % 4) builder.bin.push_back('\0');
  builder.gltf["buffers"] = {{{"byteLength", builder.bin.size()}},
                             {{"byteLength", 1000}, {"extensions", {{meshopt, {{"fallback", true}}}}}}};
}

// sound() as a Draco stream, by one of its two methods.
inline std::vector<unsigned char> encoded_floor(draco::MeshEncoderMethod method) {
  draco::TriangleSoupMeshBuilder soup;
  soup.Start(2);
  const int position = soup.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int atlas = soup.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const std::vector<glm::vec3> places = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
  const std::vector<glm::vec2> charts = {{0.1f, 0.9f}, {0.9f, 0.9f}, {0.9f, 0.1f}, {0.1f, 0.1f}};
  for (std::uint32_t face = 0; face < 2; ++face) {
    const auto a = corners[3 * face], b = corners[3 * face + 1], c = corners[3 * face + 2];
    soup.SetAttributeValuesForFace(position, draco::FaceIndex(face), &places[a], &places[b], &places[c]);
    soup.SetAttributeValuesForFace(atlas, draco::FaceIndex(face), &charts[a], &charts[b], &charts[c]);
  }
  const auto mesh = soup.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 14);
  draco::EncoderBuffer out;
  if (!encoder.EncodeMeshToBuffer(*mesh, &out).ok()) throw std::runtime_error("Draco does not encode");
  return {out.data(), out.data() + out.size()};
}

inline SceneBuilder packed_by_draco(const std::vector<unsigned char>& bytes) {
  SceneBuilder builder = sound();
  for (const int accessor : {0, 1, 2}) accessor_json(builder, accessor).erase("bufferView");
  builder.primitive(0)["extensions"][draco_extension] = {{"bufferView", add_bytes(builder, bytes)},
                                                         {"attributes", {{"POSITION", 0}, {"TEXCOORD_1", 1}}}};
  builder.gltf["extensionsRequired"] = {draco_extension};
  return builder;
}

}  // namespace lichtveld::testing
