// Accessors whose every element is known to lie inside its buffer.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <string>

namespace lichtveld::scene {

class Accessor {
 public:
  // `what` names the accessor in messages ("node "floor", primitive 0, POSITION"). Throws SceneError for one
  // that does not exist, is sparse, or does not fit its buffer view.
  Accessor(const tinygltf::Model& model, int index, std::string what);

  std::size_t count() const { return count_; }

  // Throw SceneError unless the accessor is of that kind.
  void require_vec3() const;     // float VEC3
  void require_vec2() const;     // float VEC2, or VEC2 of normalised unsigned bytes or shorts
  void require_indices() const;  // SCALAR of unsigned bytes, shorts or ints

  // Element i < count(), of the kind that was required.
  glm::vec3 vec3(std::size_t i) const { return {real(i, 0), real(i, 1), real(i, 2)}; }
  glm::vec2 vec2(std::size_t i) const { return {real(i, 0), real(i, 1)}; }
  std::uint32_t index(std::size_t i) const { return whole(i, 0); }

  // Element i < count() as it lies in the file.
  const unsigned char* element(std::size_t i) const { return data_ + i * stride_; }
  std::size_t element_bytes() const;

 private:
  float real(std::size_t i, int component) const;
  std::uint32_t whole(std::size_t i, int component) const;

  std::string what_;
  const unsigned char* data_ = nullptr;
  std::size_t stride_ = 0, count_ = 0;
  int type_ = 0, component_type_ = 0;
  bool normalised_ = false;
};

}  // namespace lichtveld::scene
