// What is checked of a file before tinygltf sees it.
#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>

#include "compression.hpp"
#include "document.hpp"
#include "extensions.hpp"
#include "lichtveld/scene/scene.hpp"
#include "model.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;

constexpr std::size_t max_buffer_bytes = 1u << 30;  // over all buffers

std::uint32_t little_endian(std::span<const std::uint8_t> bytes, std::size_t at) {
  return bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16 | std::uint32_t{bytes[at + 3]} << 24;
}

// The JSON chunk of a .glb, after the lengths of all chunks have been checked against the file.
std::span<const std::uint8_t> json_chunk(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 20)
    throw SceneError("truncated: a .glb has at least 20 bytes, this one " + std::to_string(bytes.size()));
  if (const auto version = little_endian(bytes, 4); version != 2) {
    throw SceneError("glTF binary version " + std::to_string(version) + ", expected 2: export it as glTF 2.0");
  }
  const std::size_t length = little_endian(bytes, 8);
  if (length > bytes.size()) {
    throw SceneError("truncated: its header promises " + std::to_string(length) + " bytes, the file has " +
                     std::to_string(bytes.size()));
  }
  if (length < 20)
    throw SceneError("damaged: its header promises " + std::to_string(length) +
                     " bytes, and a .glb has at least 20");
  for (std::size_t at = 12, chunk = 0; at < length; ++chunk) {
    if (length - at < 8 || little_endian(bytes, at) > length - at - 8) {
      throw SceneError("damaged: chunk " + std::to_string(chunk) + " is longer than the file");
    }
    at += 8 + little_endian(bytes, at);
  }
  return bytes.subspan(20, little_endian(bytes, 12));
}

bool is_binary(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

// The array of objects of that name, or an empty one.
const json& list(const json& root, const char* key) {
  static const json none = json::array();
  const auto found = root.find(key);
  if (found == root.end()) return none;
  if (!found->is_array()) throw SceneError(std::string("\"") + key + "\" is no array");
  for (const json& entry : *found) {
    if (!entry.is_object()) throw SceneError(std::string("\"") + key + "\" holds something that is no object");
  }
  return *found;
}

// A count or offset in bytes; tinygltf takes what is no such number for 0.
std::uint64_t bytes_of(const json& entry, const char* key, const std::string& what) {
  const auto found = entry.find(key);
  if (found == entry.end()) return 0;
  if (!found->is_number_unsigned()) throw SceneError(what + ": " + key + " is no whole number of bytes");
  return found->get<std::uint64_t>();
}

void check_uri(const json& entry, const std::string& what) {
  const auto found = entry.find("uri");
  if (found == entry.end()) return;
  if (!found->is_string()) throw SceneError(what + ": uri is no string");
  const std::string uri = found->get<std::string>();
  if (uri.starts_with("data:")) return;
  std::string lower = uri;
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  // A percent sign may hide the same characters; %20 and the like stay allowed.
  const auto holds = [&](const char* part) { return lower.find(part) != std::string::npos; };
  if (uri.empty() || uri.front() == '/' || holds("..") || holds("\\") || holds(":") || holds("%2e") ||
      holds("%2f") || holds("%5c") || holds("%3a") || holds("%00")) {
    throw SceneError(what + ": uri \"" + uri.substr(0, 80) +
                     "\" leaves the scene's folder; put the file beside the scene, or export one .glb");
  }
}

// The array of that name in an object, or an empty one.
json& array_in(json& object, const char* key) {
  static json none = json::array();
  const auto found = object.find(key);
  return found == object.end() || !found->is_array() ? none : *found;
}

bool name_bind_matrices(json& root) {
  bool changed = false;
  for (json& skin : array_in(root, "skins"))
    if (!skin.contains("inverseBindMatrices")) {
      skin["inverseBindMatrices"] = -1;
      changed = true;
    }
  return changed;
}

// Indices whose accessor has a sparse part alone go as an attribute.
bool hide_sparse_indices(json& root) {
  const json& accessors = array_in(root, "accessors");
  bool changed = false;
  for (json& mesh : array_in(root, "meshes"))
    for (json& primitive : array_in(mesh, "primitives")) {
      if (!primitive.is_object() || !primitive.contains("indices") || !primitive.contains("attributes"))
        continue;
      const json& index = primitive["indices"];
      if (!index.is_number_unsigned() || index.get<std::size_t>() >= accessors.size() ||
          accessors[index.get<std::size_t>()].contains("bufferView") || !primitive["attributes"].is_object())
        continue;
      primitive["attributes"][hidden_indices] = index;
      primitive.erase("indices");
      changed = true;
    }
  return changed;
}

// Of data in URIs tinygltf reads a few types alone, though nobody asks for their type.
bool strip_data_types(json& root) {
  constexpr const char *any = "data:application/octet-stream;base64,", *mark = ";base64,";
  bool changed = false;
  for (const char* key : {"images", "buffers"})
    for (json& entry : array_in(root, key)) {
      if (!entry.contains("uri") || !entry["uri"].is_string()) continue;
      const std::string uri = entry["uri"].get<std::string>();
      const std::size_t data = uri.find(mark);
      if (!uri.starts_with("data:") || data == std::string::npos || uri.starts_with(any)) continue;
      entry["uri"] = any + uri.substr(data + std::strlen(mark));
      changed = true;
    }
  return changed;
}

// tinygltf wants what glTF leaves out, and less than glTF allows.
bool suit_tinygltf(json& root) {
  const bool skins = name_bind_matrices(root), indices = hide_sparse_indices(root);
  return strip_data_types(root) || skins || indices;
}

// The file with that JSON instead of its own.
std::vector<std::uint8_t> with_json(std::span<const std::uint8_t> bytes, bool binary, const json& root) {
  std::string text = root.dump();
  if (!binary) return {text.begin(), text.end()};
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto rest = bytes.subspan(20 + json_chunk(bytes).size());
  std::vector<std::uint8_t> result(bytes.begin(), bytes.begin() + 20);
  const auto put = [&](std::size_t at, std::size_t value) {
    for (std::size_t i = 0; i < 4; ++i) result[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
  };
  put(8, 20 + text.size() + rest.size());
  put(12, text.size());
  result.insert(result.end(), text.begin(), text.end());
  result.insert(result.end(), rest.begin(), rest.end());
  return result;
}

}  // namespace

std::span<const std::uint8_t> json_of(std::span<const std::uint8_t> bytes) {
  return is_binary(bytes) ? json_chunk(bytes) : bytes;
}

std::vector<std::uint8_t> checked(std::vector<std::uint8_t> bytes, Remarks& remarks) {
  const bool binary = is_binary(bytes);
  bool left_out = false;
  json root = read_document(json_of(bytes), left_out);
  for (const char* key : {"accessors", "bufferViews", "buffers", "images", "materials", "meshes", "nodes",
                          "scenes", "skins", "textures"})
    list(root, key);
  check_extensions(root, remarks);
  const bool pointed = point_at_compressed(root);
  const bool changed = suit_tinygltf(root) || pointed || left_out;

  const json& buffers = list(root, "buffers");
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::string what = "buffer " + std::to_string(i);
    check_uri(buffers[i], what);
    // Each such buffer would be a copy of the whole binary chunk.
    if (!buffers[i].contains("uri") && (!binary || i > 0)) throw SceneError(what + " has no uri");
    const std::uint64_t length = bytes_of(buffers[i], "byteLength", what);
    if (length > max_buffer_bytes || (total += length) > max_buffer_bytes) {
      throw SceneError(what + ": the scene's buffers are larger than 1 GiB together");
    }
  }
  const json& views = list(root, "bufferViews");
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::string what = "buffer view " + std::to_string(i);
    if (!views[i].contains("buffer")) throw SceneError(what + " names no buffer");
    const std::uint64_t buffer = bytes_of(views[i], "buffer", what);
    if (buffer >= buffers.size()) throw SceneError(what + ": there is no buffer " + std::to_string(buffer));
    const std::uint64_t size = bytes_of(buffers[buffer], "byteLength", what);
    const std::uint64_t offset = bytes_of(views[i], "byteOffset", what);
    const std::uint64_t length = bytes_of(views[i], "byteLength", what);
    bytes_of(views[i], "byteStride", what);
    if (length == 0 || offset > size || length > size - offset) {
      throw SceneError(what + ": bytes " + std::to_string(offset) + " + " + std::to_string(length) +
                       " do not lie in buffer " + std::to_string(buffer) + " of " + std::to_string(size));
    }
  }
  const json& accessors = list(root, "accessors");
  for (std::size_t i = 0; i < accessors.size(); ++i) {
    const std::string what = "accessor " + std::to_string(i);
    bytes_of(accessors[i], "byteOffset", what);
    bytes_of(accessors[i], "count", what);
  }
  const json& images = list(root, "images");
  for (std::size_t i = 0; i < images.size(); ++i) check_uri(images[i], "image " + std::to_string(i));
  return changed ? with_json(bytes, binary, root) : std::move(bytes);
}

}  // namespace lichtveld::scene
