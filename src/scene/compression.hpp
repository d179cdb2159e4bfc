// Compressed geometry to plain buffers: EXT_meshopt_compression and KHR_draco_mesh_compression.
#pragma once

#include <tiny_gltf.h>

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace lichtveld::scene {

// KHR_ is the same with later codecs, which are refused where the library lacks them.
inline constexpr std::array meshopt_names = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
inline constexpr const char* draco_name = "KHR_draco_mesh_compression";

// Before tinygltf reads the file: compressed buffer views become views of their compressed bytes, as they have
// no others, and compressed primitives lose the accessor of their indices, which has no bytes. Says whether it
// changed anything.
bool point_at_compressed(nlohmann::json& root);

// After it: each compressed buffer view and primitive gets buffers of what it holds. No more memory is taken
// than the file's own counts and limits allow. Throws SceneError.
void decompress(tinygltf::Model& model);

// Their parts, which take the bytes that they need from `bytes_left`.
void decompress_meshopt(tinygltf::Model& model, std::size_t& bytes_left);
void decompress_draco(tinygltf::Model& model, std::size_t& bytes_left);

// A whole number of 0 or more in an extension. Throws SceneError.
std::size_t count_of(const tinygltf::Value& extension, const char* key, const std::string& what);

// A new buffer with these bytes, and a view of it whole; the view's index.
int add_view(tinygltf::Model& model, std::vector<unsigned char> bytes);

}  // namespace lichtveld::scene
