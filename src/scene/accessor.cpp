#include "accessor.hpp"

#include <cstring>
#include <utility>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {
namespace {

template <typename T>
T load(const unsigned char* at) {  // buffers need not be aligned
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

}  // namespace

Accessor::Accessor(const tinygltf::Model& model, int index, std::string what) : what_(std::move(what)) {
  if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size()) {
    throw SceneError(what_ + ": there is no accessor " + std::to_string(index));
  }
  const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
  what_ += " (accessor " + std::to_string(index) + ")";
  if (accessor.sparse.isSparse)
    throw SceneError(what_ + " is sparse, which is not supported: export without sparse accessors");
  if (accessor.bufferView < 0 || static_cast<std::size_t>(accessor.bufferView) >= model.bufferViews.size()) {
    throw SceneError(what_ + ": there is no buffer view " + std::to_string(accessor.bufferView));
  }
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size()) {
    throw SceneError(what_ + ": there is no buffer " + std::to_string(view.buffer));
  }
  const std::vector<unsigned char>& buffer = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  const int component = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
  const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  if (component <= 0 || components <= 0) throw SceneError(what_ + ": unknown type");
  const auto element = static_cast<std::size_t>(component * components);

  stride_ = view.byteStride ? view.byteStride : element;
  count_ = accessor.count;
  if (stride_ < element)
    throw SceneError(what_ + ": byteStride " + std::to_string(stride_) + " is less than an element");
  if (count_ == 0) throw SceneError(what_ + " is empty");
  // Without a product or sum that could overflow: offsets first, then how many strides fit behind the first
  // element.
  const std::size_t length = view.byteLength, offset = accessor.byteOffset;
  const bool in_buffer = view.byteOffset <= buffer.size() && length <= buffer.size() - view.byteOffset;
  if (!in_buffer || offset > length || element > length - offset ||
      (length - offset - element) / stride_ < count_ - 1) {
    throw SceneError(what_ + ": " + std::to_string(count_) + " elements at offset " + std::to_string(offset) +
                     " do not fit buffer view " + std::to_string(accessor.bufferView) + " of " +
                     std::to_string(length) + " bytes");
  }
  data_ = buffer.data() + view.byteOffset + offset;
  type_ = accessor.type;
  component_type_ = accessor.componentType;
  normalised_ = accessor.normalized;
}

std::size_t Accessor::element_bytes() const {
  return static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type_)) *
      tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type_)));
}

void Accessor::require_vec3() const {
  if (type_ != TINYGLTF_TYPE_VEC3 || component_type_ != TINYGLTF_COMPONENT_TYPE_FLOAT) {
    throw SceneError(what_ + ": expected VEC3 of float");
  }
}

void Accessor::require_vec2() const {
  const bool whole = component_type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                     component_type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  if (type_ != TINYGLTF_TYPE_VEC2 ||
      !(component_type_ == TINYGLTF_COMPONENT_TYPE_FLOAT || (whole && normalised_))) {
    throw SceneError(what_ + ": expected VEC2 of float or of normalised unsigned bytes or shorts");
  }
}

void Accessor::require_indices() const {
  if (type_ != TINYGLTF_TYPE_SCALAR || (component_type_ != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                                        component_type_ != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                                        component_type_ != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)) {
    throw SceneError(what_ + ": expected SCALAR of unsigned byte, short or int");
  }
}

float Accessor::real(std::size_t i, int component) const {
  if (component_type_ == TINYGLTF_COMPONENT_TYPE_FLOAT) return load<float>(data_ + i * stride_ + 4 * component);
  const float most = component_type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ? 255.0f : 65535.0f;
  return static_cast<float>(whole(i, component)) / most;
}

std::uint32_t Accessor::whole(std::size_t i, int component) const {
  const unsigned char* element = data_ + i * stride_;
  switch (component_type_) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return element[component];
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(element + 2 * component);
    default:
      return load<std::uint32_t>(element + 4 * component);
  }
}

}  // namespace lichtveld::scene
