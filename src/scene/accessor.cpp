#include "accessor.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {
namespace {

// What every element of an accessor without a buffer view is: as large as the largest, a MAT4 of doubles.
constexpr std::array<unsigned char, 128> zeros{};

template <typename T>
T load(const unsigned char* at) {  // buffers need not be aligned
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

// An unsigned whole number.
std::uint32_t whole(const unsigned char* at, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *at;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(at);
    default:
      return load<std::uint32_t>(at);
  }
}

bool counts(int component_type) {
  return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

// `count` > 0 elements of so many bytes, from `offset` on in a buffer view; a stride of 0 packs them.
Run run_of(const tinygltf::Model& model, int view_index, std::size_t offset, std::size_t element,
           std::size_t stride, std::size_t count, const std::string& what) {
  if (view_index < 0 || static_cast<std::size_t>(view_index) >= model.bufferViews.size())
    throw SceneError(what + ": there is no buffer view " + std::to_string(view_index));
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(view_index)];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
    throw SceneError(what + ": there is no buffer " + std::to_string(view.buffer));
  const std::vector<unsigned char>& buffer = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (stride == 0) stride = element;
  if (stride < element)
    throw SceneError(what + ": byteStride " + std::to_string(stride) + " is less than an element");
  // Without a product or sum that could overflow: offsets first, then how many strides fit behind the first
  // element.
  const std::size_t length = view.byteLength;
  const bool in_buffer = view.byteOffset <= buffer.size() && length <= buffer.size() - view.byteOffset;
  if (!in_buffer || offset > length || element > length - offset ||
      (length - offset - element) / stride < count - 1) {
    throw SceneError(what + ": " + std::to_string(count) + " elements at offset " + std::to_string(offset) +
                     " do not fit buffer view " + std::to_string(view_index) + " of " + std::to_string(length) +
                     " bytes");
  }
  return {buffer.data() + view.byteOffset + offset, stride, count};
}

std::size_t stride_of(const tinygltf::Model& model, int view) {
  const bool exists = view >= 0 && static_cast<std::size_t>(view) < model.bufferViews.size();
  return exists ? model.bufferViews[static_cast<std::size_t>(view)].byteStride : 0;
}

}  // namespace

Accessor::Accessor(const tinygltf::Model& model, int index, std::string what) : what_(std::move(what)) {
  if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size()) {
    throw SceneError(what_ + ": there is no accessor " + std::to_string(index));
  }
  const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
  what_ += " (accessor " + std::to_string(index) + ")";
  const int component = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
  const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  if (component <= 0 || components <= 0) throw SceneError(what_ + ": unknown type");
  const auto element_size = static_cast<std::size_t>(component * components);
  if (accessor.count == 0) throw SceneError(what_ + " is empty");
  elements_ = accessor.bufferView == -1 ? Run{zeros.data(), 0, accessor.count}
                                        : run_of(model, accessor.bufferView, accessor.byteOffset, element_size,
                                                 stride_of(model, accessor.bufferView), accessor.count, what_);
  if (accessor.sparse.isSparse) read_sparse(model, accessor, element_size);
  type_ = accessor.type;
  component_type_ = accessor.componentType;
  normalised_ = accessor.normalized;
}

void Accessor::read_sparse(const tinygltf::Model& model, const tinygltf::Accessor& accessor,
                           std::size_t element_size) {
  const auto& sparse = accessor.sparse;
  const std::string what = what_ + ", sparse part";
  if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > count())
    throw SceneError(what + ": has " + std::to_string(sparse.count) + " of " + std::to_string(count()) +
                     " elements");
  if (sparse.count == 0) return;
  if (!counts(sparse.indices.componentType))
    throw SceneError(what + ": expected indices of unsigned byte, short or int");
  if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
    throw SceneError(what + ": a byteOffset is negative");
  const auto size = static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(sparse.indices.componentType)));
  const auto changed = static_cast<std::size_t>(sparse.count);
  sparse_indices_ =
      run_of(model, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), size, 0,
             changed, what + ", indices");
  sparse_values_ = run_of(model, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
                          element_size, 0, changed, what + ", values");
  sparse_index_type_ = sparse.indices.componentType;
  std::int64_t before = -1;
  for (std::size_t k = 0; k < changed; ++k) {
    const std::int64_t at = whole(sparse_indices_.at(k), sparse_index_type_);
    if (at <= before) throw SceneError(what + ": its indices do not increase");
    before = at;
  }
  if (static_cast<std::size_t>(before) >= count())
    throw SceneError(what + ": index " + std::to_string(before) + " of " + std::to_string(count()) +
                     " elements");
}

void Accessor::require_vectors(int components) const {
  const bool vector = type_ == TINYGLTF_TYPE_VEC2 || type_ == TINYGLTF_TYPE_VEC3 || type_ == TINYGLTF_TYPE_VEC4;
  const bool known = component_type_ == TINYGLTF_COMPONENT_TYPE_FLOAT ||
                     component_type_ == TINYGLTF_COMPONENT_TYPE_BYTE ||
                     component_type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                     component_type_ == TINYGLTF_COMPONENT_TYPE_SHORT ||
                     component_type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  if (!vector || !known || this->components() != components)
    throw SceneError(what_ + ": expected VEC" + std::to_string(components) + " of float, byte or short");
}

std::size_t Accessor::element_bytes() const {
  return static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type_)) * components());
}

void Accessor::require_matrices() const {
  if (type_ != TINYGLTF_TYPE_MAT4 || component_type_ != TINYGLTF_COMPONENT_TYPE_FLOAT)
    throw SceneError(what_ + ": expected MAT4 of float");
}

void Accessor::require_indices() const {
  if (type_ != TINYGLTF_TYPE_SCALAR || !counts(component_type_))
    throw SceneError(what_ + ": expected SCALAR of unsigned byte, short or int");
}

glm::vec2 Accessor::vec2(std::size_t i) const {
  const unsigned char* at = element(i);
  return {real(at, 0), real(at, 1)};
}

glm::vec3 Accessor::vec3(std::size_t i) const {
  const unsigned char* at = element(i);
  return {real(at, 0), real(at, 1), real(at, 2)};
}

glm::vec4 Accessor::vec4(std::size_t i) const {
  const unsigned char* at = element(i);
  return {real(at, 0), real(at, 1), real(at, 2), real(at, 3)};
}

glm::mat4 Accessor::mat4(std::size_t i) const {
  const unsigned char* at = element(i);
  glm::mat4 result;
  for (int c = 0; c < 16; ++c) result[c / 4][c % 4] = real(at, c);
  return result;
}

std::uint32_t Accessor::index(std::size_t i) const {
  return whole(element(i), component_type_);
}

const unsigned char* Accessor::element(std::size_t i) const {
  std::size_t low = 0, high = sparse_indices_.count;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    const std::size_t at = whole(sparse_indices_.at(middle), sparse_index_type_);
    if (at == i) return sparse_values_.at(middle);
    if (at < i)
      low = middle + 1;
    else
      high = middle;
  }
  return elements_.at(i);
}

float Accessor::real(const unsigned char* element, int component) const {
  const auto signed_share = [&](float value, float most) {
    return normalised_ ? std::max(value / most, -1.0f) : value;
  };
  const auto share = [&](float value, float most) { return normalised_ ? value / most : value; };
  switch (component_type_) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return signed_share(load<std::int8_t>(element + component), 127);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return share(element[component], 255);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return signed_share(load<std::int16_t>(element + 2 * component), 32767);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return share(load<std::uint16_t>(element + 2 * component), 65535);
    default:
      return load<float>(element + 4 * component);
  }
}

}  // namespace lichtveld::scene
