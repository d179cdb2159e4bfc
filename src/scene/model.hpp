// A glTF file as tinygltf's model, checked as far as a model alone can be.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <new>
#include <span>
#include <string>
#include <vector>

#include "document.hpp"
#include "lichtveld/scene/scene.hpp"
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

// The same of a file's bytes; what it names lies beside `file`.
tinygltf::Model parse_model(std::vector<std::uint8_t> bytes, const std::filesystem::path& file,
                            Remarks& remarks);

// The JSON's text in a file's bytes. Throws SceneError for a damaged .glb.
std::span<const std::uint8_t> json_of(std::span<const std::uint8_t> bytes);

// The JSON of a file, to be written anew.
Document document_of(const std::filesystem::path& file);

// What read() gives; what it throws, our own errors and what tinygltf lets escape from its parser, as
// SceneError with the file's name.
template <typename Read>
auto naming(const std::filesystem::path& file, const Read& read) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    throw SceneError(file.string() + ": not enough memory to read it");
  } catch (const std::exception& e) {
    throw SceneError(printable(file.string() + ": " + e.what()));
  }
}

// The bytes of a buffer view, which was checked against its buffer when the file was read. Throws SceneError
// where there is none of that number.
std::span<const unsigned char> bytes_of_view(const tinygltf::Model& model, std::size_t view,
                                             const std::string& what);

// How messages call a node: "name", or node 7 where it has none.
std::string node_name(const tinygltf::Model& model, int node);

}  // namespace lichtveld::scene
