#include "plain_file.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <numeric>

#include "accessor.hpp"
#include "image.hpp"
#include "lichtveld/scene/scene.hpp"
#include "parts.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;

constexpr std::array gone = {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression",
                             "EXT_mesh_gpu_instancing"};

constexpr std::size_t most_bytes = 1u << 30;  // of the buffer that is written: no more is read

constexpr std::uint32_t json_chunk_type = 0x4e4f534a, binary_chunk_type = 0x004e4942;

void append(PlainFile::Bytes& to, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) to.push_back(static_cast<unsigned char>(value >> shift));
}

void pad(PlainFile::Bytes& bytes, unsigned char with) {
  while (bytes.size() % 4 != 0) bytes.push_back(with);
}

// The least and the most of each component of a VEC3 of float, which POSITION has to state.
void state_range(json& description, const PlainFile::Bytes& bytes, std::size_t stride) {
  if (description["componentType"] != TINYGLTF_COMPONENT_TYPE_FLOAT || description["type"] != "VEC3") return;
  std::array<float, 3> low{}, high{};
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  for (std::size_t at = 0; at + 12 <= bytes.size(); at += stride)
    for (std::size_t c = 0; c < 3; ++c) {
      float value = 0;
      std::memcpy(&value, &bytes[at + 4 * c], 4);
      low[c] = std::min(low[c], value);
      high[c] = std::max(high[c], value);
    }
  description["min"] = low;
  description["max"] = high;
}

}  // namespace

json without_compression(json primitive) {
  if (!primitive.contains("extensions")) return primitive;
  primitive["extensions"].erase("KHR_draco_mesh_compression");
  if (primitive["extensions"].empty()) primitive.erase("extensions");
  return primitive;
}

PlainFile::PlainFile(Document document, const tinygltf::Model& model)
    : document_(std::move(document)), root_(document_.root), model_(model), is_new_(model.nodes.size()) {
  take_nodes();
}

// What reading made of the nodes: instances are children of their node, and a scene is there.
void PlainFile::take_nodes() {
  json& nodes = root_["nodes"];
  const auto put = [](json& node, const char* key, const std::vector<double>& numbers) {
    if (!numbers.empty()) node[key] = numbers;
  };
  const std::size_t in_file = nodes.size();
  for (std::size_t i = in_file; i < model_.nodes.size(); ++i) {
    const auto& in = model_.nodes[i];
    json node = {{"name", in.name}};
    put(node, "translation", in.translation);
    put(node, "rotation", in.rotation);
    put(node, "scale", in.scale);
    put(node, "weights", in.weights);
    if (in.mesh >= 0) node["mesh"] = in.mesh;
    nodes.push_back(std::move(node));
  }
  for (std::size_t i = 0; i < in_file; ++i) {
    json& node = nodes[i];
    const auto& in = model_.nodes[i];
    if (!in.children.empty()) node["children"] = in.children;
    if (in.mesh < 0) node.erase("mesh");
    if (!node.contains("extensions")) continue;
    node["extensions"].erase("EXT_mesh_gpu_instancing");
    if (node["extensions"].empty()) node.erase("extensions");
  }
  if (root_.contains("scenes")) return;
  root_["scenes"] = json::array({{{"nodes", model_.scenes.at(0).nodes}}});
  root_["scene"] = 0;
}

// Before they are taken: an accessor without bytes of its own may claim any number of elements.
void PlainFile::require_room(std::size_t elements, std::size_t bytes) const {
  const std::size_t left = most_bytes - std::min(binary_.size(), most_bytes);
  if (elements > left / bytes) throw SceneError("written anew it would be larger than 1 GiB: simplify it");
}

int PlainFile::add_view(const Bytes& bytes, int target, std::size_t stride) {
  pad(binary_, 0);
  json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  if (target == TINYGLTF_TARGET_ARRAY_BUFFER) view["byteStride"] = stride;
  binary_.insert(binary_.end(), bytes.begin(), bytes.end());
  views_.push_back(std::move(view));
  return static_cast<int>(views_.size()) - 1;
}

int PlainFile::add_accessor(json description, const Bytes& bytes, int target, std::size_t stride) {
  description["bufferView"] = add_view(bytes, target, stride);
  accessors_.push_back(std::move(description));
  return static_cast<int>(accessors_.size()) - 1;
}

json PlainFile::described(int accessor) const {
  const auto& in = model_.accessors.at(static_cast<std::size_t>(accessor));
  static const std::map<int, const char*> types = {
      {TINYGLTF_TYPE_SCALAR, "SCALAR"}, {TINYGLTF_TYPE_VEC2, "VEC2"}, {TINYGLTF_TYPE_VEC3, "VEC3"},
      {TINYGLTF_TYPE_VEC4, "VEC4"},     {TINYGLTF_TYPE_MAT2, "MAT2"}, {TINYGLTF_TYPE_MAT3, "MAT3"},
      {TINYGLTF_TYPE_MAT4, "MAT4"}};
  json result = {{"componentType", in.componentType}, {"count", in.count}, {"type", types.at(in.type)}};
  if (in.normalized) result["normalized"] = true;
  if (!in.name.empty()) result["name"] = in.name;
  return result;
}

int PlainFile::carried(int accessor, int target) {
  if (const auto known = carried_.find(accessor); known != carried_.end()) return known->second;
  const Accessor in(model_, accessor, "the file");
  json description = described(accessor);
  const auto& was = model_.accessors[static_cast<std::size_t>(accessor)];
  if (!was.minValues.empty()) description["min"] = was.minValues;
  if (!was.maxValues.empty()) description["max"] = was.maxValues;
  const std::size_t element = in.element_bytes();
  require_room(in.count(), element);
  Bytes bytes(in.count() * element);
  for (std::size_t i = 0; i < in.count(); ++i) std::memcpy(&bytes[i * element], in.element(i), element);
  return carried_[accessor] = add_accessor(std::move(description), bytes, target, element);
}

int PlainFile::chosen(int accessor, std::span<const std::uint32_t> elements, const std::string& semantic) {
  const Accessor in(model_, accessor, semantic);
  json description = described(accessor);
  description["count"] = elements.size();
  const std::size_t element = in.element_bytes(), stride = (element + 3) / 4 * 4;
  require_room(elements.size(), stride);
  Bytes bytes(elements.size() * stride);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (elements[i] >= in.count()) throw SceneError(semantic + " has fewer elements than POSITION");
    std::memcpy(&bytes[i * stride], in.element(elements[i]), element);
  }
  if (semantic == "POSITION") state_range(description, bytes, stride);
  return add_accessor(std::move(description), bytes, TINYGLTF_TARGET_ARRAY_BUFFER, stride);
}

int PlainFile::add_vectors(std::span<const float> numbers, std::size_t components, const char* type) {
  Bytes bytes(numbers.size_bytes());
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return add_accessor({{"componentType", TINYGLTF_COMPONENT_TYPE_FLOAT},
                       {"count", numbers.size() / components},
                       {"type", type}},
                      bytes, TINYGLTF_TARGET_ARRAY_BUFFER, components * sizeof(float));
}

int PlainFile::add_vec2(std::span<const float> numbers) {
  return add_vectors(numbers, 2, "VEC2");
}

int PlainFile::add_vec3(std::span<const float> numbers) {
  return add_vectors(numbers, 3, "VEC3");
}

int PlainFile::add_indices(std::span<const std::uint32_t> indices) {
  Bytes bytes(indices.size_bytes());
  std::memcpy(bytes.data(), indices.data(), bytes.size());
  return add_accessor(
      {{"componentType", TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT}, {"count", indices.size()}, {"type", "SCALAR"}},
      bytes, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, sizeof(std::uint32_t));
}

int PlainFile::add_mesh(json mesh) {
  meshes_.push_back(std::move(mesh));
  return static_cast<int>(meshes_.size()) - 1;
}

void PlainFile::show(std::size_t node, int mesh) {
  root_["nodes"][node]["mesh"] = mesh;
  is_new_[node] = true;
}

int PlainFile::carried_mesh(int mesh) {
  if (const auto known = carried_meshes_.find(mesh); known != carried_meshes_.end()) return known->second;
  const auto& in = model_.meshes.at(static_cast<std::size_t>(mesh));
  json copy = root_["meshes"].at(static_cast<std::size_t>(mesh));
  for (std::size_t i = 0; i < in.primitives.size(); ++i) {
    const auto& primitive = in.primitives[i];
    json out = without_compression(copy["primitives"].at(i));
    if (primitive.indices >= 0)
      out["indices"] = carried(primitive.indices, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    out["attributes"] = json::object();
    const auto whole = [&](int accessor, const std::string& semantic) {
      const auto [known, is_new] = carried_vertices_.try_emplace(accessor);
      if (!is_new) return known->second;
      const Accessor in_file(model_, accessor, semantic);
      require_room(in_file.count(), in_file.element_bytes());
      std::vector<std::uint32_t> all(in_file.count());
      std::iota(all.begin(), all.end(), 0u);
      return known->second = chosen(accessor, all, semantic);
    };
    for (const auto& [semantic, accessor] : primitive.attributes)
      out["attributes"][semantic] = whole(accessor, semantic);
    for (std::size_t t = 0; t < primitive.targets.size(); ++t)
      for (const auto& [semantic, accessor] : primitive.targets[t])
        out["targets"][t][semantic] = whole(accessor, semantic);
    copy["primitives"][i] = std::move(out);
  }
  return carried_meshes_[mesh] = add_mesh(std::move(copy));
}

void PlainFile::carry_images() {
  if (!root_.contains("images")) return;
  for (std::size_t i = 0; i < root_["images"].size(); ++i) {
    json& image = root_["images"][i];
    const auto encoded = encoded_bytes(model_, model_.images.at(i));
    const char* format = format_of(encoded);
    if (!format) continue;  // missing, or nothing that can be said without its name
    const Bytes bytes(encoded.begin(), encoded.end());
    image.erase("uri");
    image["mimeType"] = std::string("image/") + format;
    image["bufferView"] = add_view(bytes, 0, 0);
  }
}

void PlainFile::name_light_map(const std::string& uri) {
  json& scene = root_["scenes"].at(static_cast<std::size_t>(scene_of(model_)));
  json extras = document_.extras_of(scene);
  if (!extras.is_object()) extras = json::object();
  extras["lightMap"] = uri;
  scene["extras"] = std::move(extras);
}

PlainFile::Bytes PlainFile::finish() {
  if (root_.contains("nodes"))
    for (std::size_t node = 0; node < root_["nodes"].size(); ++node) {
      json& in = root_["nodes"][node];
      if (in.contains("mesh") && !is_new_[node]) in["mesh"] = carried_mesh(in["mesh"].get<int>());
    }
  const auto carry = [&](json& owner, const char* key) {
    if (owner.contains(key)) owner[key] = carried(owner[key].get<int>());
  };
  if (root_.contains("animations"))
    for (json& animation : root_["animations"])
      for (json& sampler : animation["samplers"]) carry(sampler, "input"), carry(sampler, "output");
  if (root_.contains("skins"))
    for (json& skin : root_["skins"]) carry(skin, "inverseBindMatrices");
  carry_images();
  pad(binary_, 0);
  for (const auto& [key, value] :
       {std::pair{"accessors", &accessors_}, {"bufferViews", &views_}, {"meshes", &meshes_}})
    root_[key] = std::move(*value);
  root_["buffers"] = json::array({{{"byteLength", binary_.size()}}});
  for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
    if (!root_.contains(key)) continue;
    json left = json::array();
    for (const json& name : root_[key])
      if (std::ranges::find(gone, name) == gone.end()) left.push_back(name);
    if (left.empty())
      root_.erase(key);
    else
      root_[key] = left;
  }
  std::string text = document_.text();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  constexpr std::size_t header = 12, chunk_header = 8;
  const std::size_t length = header + 2 * chunk_header + text.size() + binary_.size();
  if (length > std::numeric_limits<std::uint32_t>::max())
    throw SceneError("unwrapped it would be larger than a .glb can be: simplify it");
  Bytes glb = {'g', 'l', 'T', 'F'};
  glb.reserve(length);
  append(glb, 2);
  append(glb, static_cast<std::uint32_t>(length));
  append(glb, static_cast<std::uint32_t>(text.size()));
  append(glb, json_chunk_type);
  glb.insert(glb.end(), text.begin(), text.end());
  append(glb, static_cast<std::uint32_t>(binary_.size()));
  append(glb, binary_chunk_type);
  glb.insert(glb.end(), binary_.begin(), binary_.end());
  return glb;
}

}  // namespace lichtveld::scene
