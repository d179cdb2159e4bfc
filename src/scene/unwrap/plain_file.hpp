// A glTF file written anew as one .glb whose accessors are plain: neither sparse nor compressed. What is not
// asked to change stays: materials, animations, cameras, names, extras, extensions.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "document.hpp"

namespace lichtveld::scene {

// A primitive whose vertices are written plain.
nlohmann::json without_compression(nlohmann::json primitive);

class PlainFile {
 public:
  using Bytes = std::vector<unsigned char>;

  // Of a file's JSON and its model as it was read: with a scene, and each instance a node. The model must
  // outlive it.
  PlainFile(Document document, const tinygltf::Model& model);
  PlainFile(const PlainFile&) = delete;
  PlainFile& operator=(const PlainFile&) = delete;

  nlohmann::json& root() { return root_; }

  // Numbers of the accessors that are written: one of the model's, whole, or chosen elements of it for
  // vertices; or one of our own. `target` is what its buffer view is for, 0 for neither vertices nor indices.
  int carried(int accessor, int target = 0);
  int chosen(int accessor, std::span<const std::uint32_t> elements, const std::string& semantic);
  int add_vec2(std::span<const float> numbers);
  int add_vec3(std::span<const float> numbers);
  int add_indices(std::span<const std::uint32_t> indices);

  // Adds a mesh whose primitives have numbers of written accessors; the number that nodes give.
  int add_mesh(nlohmann::json mesh);

  // From now on a node shows an added mesh.
  void show(std::size_t node, int mesh);

  // Its scene's extras.lightMap; extras that are no object make room for it.
  void name_light_map(const std::string& uri);

  // The .glb. Meshes that were not added are those of the nodes that were not asked to change.
  Bytes finish();

 private:
  nlohmann::json described(int accessor) const;
  void require_room(std::size_t elements, std::size_t bytes) const;
  int add_view(const Bytes& bytes, int target, std::size_t stride);
  int add_vectors(std::span<const float> numbers, std::size_t components, const char* type);
  int add_accessor(nlohmann::json description, const Bytes& bytes, int target, std::size_t stride);
  int carried_mesh(int mesh);
  void take_nodes();
  void carry_images();

  Document document_;
  nlohmann::json& root_;
  const tinygltf::Model& model_;
  nlohmann::json accessors_ = nlohmann::json::array(), views_ = nlohmann::json::array(),
                 meshes_ = nlohmann::json::array();
  std::map<int, int> carried_, carried_meshes_, carried_vertices_;  // by the file's
  std::vector<bool> is_new_;                                        // by node: its mesh is an added one
  Bytes binary_;
};

}  // namespace lichtveld::scene
