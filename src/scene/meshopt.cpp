// EXT_meshopt_compression.
#include <meshoptimizer.h>

#include <span>

#include "compression.hpp"
#include "lichtveld/scene/scene.hpp"
#include "model.hpp"

namespace lichtveld::scene {
namespace {

// Bytes out of one byte in, at most: the codec of attributes has a quarter of a byte for 256 equal ones. What
// promises more is damaged.
constexpr std::size_t max_ratio = 1024;

// How a buffer view is compressed.
struct Packed {
  std::size_t count = 0, stride = 0;  // elements, and bytes of each
  std::string mode, filter;
};

Packed packed_of(const tinygltf::Value& extension, const std::string& what) {
  Packed result{count_of(extension, "count", what), count_of(extension, "byteStride", what), "", "NONE"};
  if (extension.Get("mode").IsString()) result.mode = extension.Get("mode").Get<std::string>();
  if (extension.Get("filter").IsString()) result.filter = extension.Get("filter").Get<std::string>();
  return result;
}

// What the library takes for granted.
void check(const Packed& packed, const std::string& what) {
  const std::size_t stride = packed.stride;
  const auto require = [&](bool good, const std::string& reason) {
    if (!good) throw SceneError(what + ": " + reason);
  };
  const bool attributes = packed.mode == "ATTRIBUTES";
  require(attributes || packed.mode == "TRIANGLES" || packed.mode == "INDICES",
          "unknown mode \"" + packed.mode + "\"");
  require(packed.count > 0, "it has no elements");
  require(attributes ? stride > 0 && stride % 4 == 0 && stride <= 256 : stride == 2 || stride == 4,
          "byteStride " + std::to_string(stride) + " does not go with mode " + packed.mode);
  require(packed.mode != "TRIANGLES" || packed.count % 3 == 0, "no whole number of triangles");
  require(packed.filter == "NONE" || attributes, "a filter goes with mode ATTRIBUTES alone");
  require(packed.filter != "OCTAHEDRAL" || stride == 4 || stride == 8,
          "OCTAHEDRAL wants a byteStride of 4 or 8");
  require(packed.filter != "QUATERNION" || stride == 8, "QUATERNION wants a byteStride of 8");
}

void apply_filter(const Packed& packed, std::vector<unsigned char>& bytes, const std::string& what) {
  if (packed.filter == "OCTAHEDRAL")
    meshopt_decodeFilterOct(bytes.data(), packed.count, packed.stride);
  else if (packed.filter == "QUATERNION")
    meshopt_decodeFilterQuat(bytes.data(), packed.count, packed.stride);
  else if (packed.filter == "EXPONENTIAL")
    meshopt_decodeFilterExp(bytes.data(), packed.count, packed.stride);
  else if (packed.filter != "NONE")
    throw SceneError(what + ": the filter " + packed.filter +
                     " is not read; undo the compression with npx @gltf-transform/cli copy in.glb out.glb");
}

std::vector<unsigned char> decode(std::span<const unsigned char> in, const Packed& packed,
                                  std::size_t& bytes_left, const std::string& what) {
  check(packed, what);
  // Both factors are below 2^31.
  const std::size_t size = packed.count * packed.stride;
  if (size / max_ratio > in.size())
    throw SceneError(what + ": " + std::to_string(in.size()) + " bytes cannot hold " + std::to_string(size));
  if (size > bytes_left) throw SceneError(what + ": the scene's geometry is larger than 1 GiB");
  bytes_left -= size;
  std::vector<unsigned char> out(size);
  int (*decoder)(void*, std::size_t, std::size_t, const unsigned char*, std::size_t) =
      meshopt_decodeVertexBuffer;
  if (packed.mode == "TRIANGLES") decoder = meshopt_decodeIndexBuffer;
  if (packed.mode == "INDICES") decoder = meshopt_decodeIndexSequence;
  if (decoder(out.data(), packed.count, packed.stride, in.data(), in.size()) != 0)
    throw SceneError(what +
                     ": its bytes do not decode; undo the compression with npx @gltf-transform/cli copy "
                     "in.glb out.glb");
  apply_filter(packed, out, what);
  return out;
}

}  // namespace

void decompress_meshopt(tinygltf::Model& model, std::size_t& bytes_left) {
  for (std::size_t i = 0; i < model.bufferViews.size(); ++i)
    for (const char* name : meshopt_names) {
      const auto found = model.bufferViews[i].extensions.find(name);
      if (found == model.bufferViews[i].extensions.end()) continue;
      const std::string what = "buffer view " + std::to_string(i) + ": " + name;
      const Packed packed = packed_of(found->second, what);
      tinygltf::BufferView& view = model.bufferViews[i];
      auto bytes = decode(bytes_of_view(model, i, what), packed, bytes_left, what);
      view.buffer = static_cast<int>(model.buffers.size());
      view.byteOffset = 0;
      view.byteLength = bytes.size();
      view.byteStride = packed.mode == "ATTRIBUTES" ? packed.stride : 0;
      view.extensions.erase(name);
      model.buffers.emplace_back().data = std::move(bytes);
      break;
    }
}

}  // namespace lichtveld::scene
