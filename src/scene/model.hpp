// A glTF file as tinygltf's model, checked as far as a model alone can be.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "remarks.hpp"

namespace lichtveld::scene {

// The file as tinygltf can read it. Refuses what tinygltf would read past, hang on or silently take for zero:
// chunk lengths of a .glb, JSON that nests too deeply, buffer views outside their buffer, offsets that are no
// counts, URIs that leave the folder, and required extensions that geometry cannot be had without. Throws
// SceneError without the file's name.
std::vector<std::uint8_t> checked(std::vector<std::uint8_t> bytes, Remarks& remarks);

// What `checked` calls indices that tinygltf would refuse.
inline constexpr const char* hidden_indices = "_HIDDEN_INDICES";

// The parsed file in plain glTF: nothing compressed, with a scene, and each instance a node. Buffers are
// loaded; an image holds its encoded bytes when it came by URI, and nothing when it lies in a buffer view.
// Throws SceneError without the file's name.
tinygltf::Model read_model(const std::filesystem::path& file, Remarks& remarks);

// How messages call a node: "name", or node 7 where it has none.
std::string node_name(const tinygltf::Model& model, int node);

}  // namespace lichtveld::scene
