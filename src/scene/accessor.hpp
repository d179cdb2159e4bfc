// Accessors whose every element is known to lie inside its buffer.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <string>

namespace lichtveld::scene {

// Elements at equal distances.
struct Run {
  const unsigned char* data = nullptr;
  std::size_t stride = 0, count = 0;

  const unsigned char* at(std::size_t i) const { return data + i * stride; }
};

class Accessor {
 public:
  // `what` names the accessor in messages ("node "floor", primitive 0, POSITION"). Without a buffer view its
  // elements are zero, but for a sparse part. Throws SceneError for one that does not exist, does not fit its
  // buffer views, or whose sparse part names elements that it has not, or not in order.
  Accessor(const tinygltf::Model& model, int index, std::string what);

  std::size_t count() const { return elements_.count; }
  int components() const { return tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type_)); }

  // Throw SceneError unless the accessor is of that kind.
  void require_vectors(
      int components) const;      // VEC2..4 of float, or of bytes or shorts (KHR_mesh_quantization)
  void require_matrices() const;  // MAT4 of float
  void require_indices() const;   // SCALAR of unsigned bytes, shorts or ints

  // Element i < count(), of the kind that was required. Normalised whole numbers are 0..1 or -1..1.
  glm::vec2 vec2(std::size_t i) const;
  glm::vec3 vec3(std::size_t i) const;
  glm::vec4 vec4(std::size_t i) const;
  glm::mat4 mat4(std::size_t i) const;
  std::uint32_t index(std::size_t i) const;

  // Element i < count() as it lies in the file.
  const unsigned char* element(std::size_t i) const;
  std::size_t element_bytes() const;

 private:
  float real(const unsigned char* element, int component) const;
  void read_sparse(const tinygltf::Model& model, const tinygltf::Accessor& accessor, std::size_t element_size);

  std::string what_;
  Run elements_;
  // The sparse part: values that stand for elements of these increasing indices.
  Run sparse_indices_, sparse_values_;
  int sparse_index_type_ = 0;
  int type_ = 0, component_type_ = 0;
  bool normalised_ = false;
};

}  // namespace lichtveld::scene
