#include "compression.hpp"

#include <nlohmann/json.hpp>
#include <string>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;

constexpr std::size_t max_bytes = std::size_t{1} << 30;  // over all that is decompressed

// An extension of an object, or none.
const json* extension_of(const json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto extensions = object.find("extensions");
  if (extensions == object.end() || !extensions->is_object()) return nullptr;
  const auto found = extensions->find(name);
  return found == extensions->end() || !found->is_object() ? nullptr : &*found;
}

// Calls `use` with each entry of an array, if it is one.
template <typename Use>
void for_each(json& root, const char* key, const Use& use) {
  if (!root.is_object()) return;
  const auto found = root.find(key);
  if (found == root.end() || !found->is_array()) return;
  for (json& entry : *found) use(entry);
}

bool point_views(json& root) {
  bool changed = false;
  for_each(root, "bufferViews", [&](json& view) {
    for (const char* name : meshopt_names)
      if (const json* packed = extension_of(view, name)) {
        for (const char* key : {"buffer", "byteOffset", "byteLength"})
          if (packed->contains(key)) view[key] = (*packed)[key];
        if (!packed->contains("byteOffset")) view["byteOffset"] = 0u;
        changed = true;
        return;
      }
  });
  // The buffers that those views had may have no bytes.
  for_each(root, "buffers", [&](json& buffer) {
    for (const char* name : meshopt_names)
      if (extension_of(buffer, name) && !buffer.contains("uri")) {
        buffer["uri"] = "data:application/octet-stream;base64,AA==";
        buffer["byteLength"] = 1u;
        changed = true;
        return;
      }
  });
  return changed;
}

bool point_primitives(json& root) {
  bool changed = false;
  for_each(root, "meshes", [&](json& mesh) {
    for_each(mesh, "primitives", [&](json& primitive) {
      if (!extension_of(primitive, draco_name) || !primitive.contains("indices")) return;
      primitive.erase("indices");
      changed = true;
    });
  });
  return changed;
}

}  // namespace

bool point_at_compressed(json& root) {
  const bool views = point_views(root);
  return point_primitives(root) || views;
}

void decompress(tinygltf::Model& model) {
  std::size_t bytes_left = max_bytes;
  decompress_meshopt(model, bytes_left);
  decompress_draco(model, bytes_left);
}

std::size_t count_of(const tinygltf::Value& extension, const char* key, const std::string& what) {
  const bool whole = extension.IsObject() && extension.Has(key) && extension.Get(key).IsInt();
  const int value = whole ? extension.Get(key).GetNumberAsInt() : -1;
  if (value < 0) throw SceneError(what + ": " + key + " is no whole number of 0 or more");
  return static_cast<std::size_t>(value);
}

int add_view(tinygltf::Model& model, std::vector<unsigned char> bytes) {
  tinygltf::BufferView view;
  view.buffer = static_cast<int>(model.buffers.size());
  view.byteLength = bytes.size();
  model.buffers.emplace_back().data = std::move(bytes);
  model.bufferViews.push_back(std::move(view));
  return static_cast<int>(model.bufferViews.size()) - 1;
}

}  // namespace lichtveld::scene
