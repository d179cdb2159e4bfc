// KHR_draco_mesh_compression.
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <span>

#include "compression.hpp"
#include "lichtveld/scene/scene.hpp"
#include "model.hpp"

namespace lichtveld::scene {
namespace {

constexpr std::uint32_t max_faces = 1u << 22;  // of one primitive; as many as a scene may have

[[noreturn]] void refuse(const std::string& what, const std::string& reason) {
  throw SceneError(
      what + ": " + reason +
      "; undo the compression with npx @gltf-transform/cli copy in.glb out.glb, or export without it");
}

// What a stream says of itself before its decoder takes memory for it.
struct Head {
  bool edgebreaker = false;
  std::uint32_t faces = 0, points = 0;
};

Head head_of(std::span<const unsigned char> bytes, const std::string& what) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) refuse(what, "no Draco stream");
  if (header.encoder_type != draco::TRIANGULAR_MESH) refuse(what, "no triangles");
  if (header.version_major != 2 || header.version_minor != 2) refuse(what, "not of Draco's format 2.2");
  buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor));
  draco::GeometryMetadata ignored;
  if ((header.flags & METADATA_FLAG_MASK) &&
      !draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &ignored))
    refuse(what, "its metadata does not decode");
  Head head{.edgebreaker = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING};
  if (!head.edgebreaker && header.encoder_method != draco::MESH_SEQUENTIAL_ENCODING)
    refuse(what, "an unknown way to encode triangles");
  std::uint8_t traversal;
  const bool read =
      head.edgebreaker
          ? buffer.Decode(&traversal) && draco::DecodeVarint(&head.points, &buffer) &&
                draco::DecodeVarint(&head.faces, &buffer)
          : draco::DecodeVarint(&head.faces, &buffer) && draco::DecodeVarint(&head.points, &buffer);
  if (!read) refuse(what, "it ends before its triangles");
  return head;
}

// A decoder that gives up before it takes more memory for attributes than `most` bytes.
template <typename Decoder>
class Limited : public Decoder {
 public:
  explicit Limited(std::size_t most) : most_(most) {}

 private:
  bool DecodeAllAttributes() override {
    const draco::PointCloud& cloud = *this->point_cloud();
    std::size_t a_point = 0;
    for (int i = 0; i < cloud.num_attributes(); ++i) {
      const draco::PointAttribute& attribute = *cloud.attribute(i);
      // Some are decoded as words first.
      const auto component = std::max(4, draco::DataTypeLength(attribute.data_type()));
      a_point += static_cast<std::size_t>(attribute.num_components()) * static_cast<std::size_t>(component);
    }
    if (a_point * std::size_t{cloud.num_points()} > most_) return false;
    return Decoder::DecodeAllAttributes();
  }

  std::size_t most_;
};

std::unique_ptr<draco::Mesh> decode(std::span<const unsigned char> bytes, std::size_t bytes_left,
                                    const std::string& what) {
  const Head head = head_of(bytes, what);
  if (head.faces > max_faces || head.points > 3 * max_faces)
    refuse(what, "it has " + std::to_string(head.faces) + " triangles, more than 4 million");
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  auto mesh = std::make_unique<draco::Mesh>();
  const draco::DecoderOptions options;
  Limited<draco::MeshEdgebreakerDecoder> edgebreaker(bytes_left);
  Limited<draco::MeshSequentialDecoder> sequential(bytes_left);
  draco::MeshDecoder& decoder = head.edgebreaker ? static_cast<draco::MeshDecoder&>(edgebreaker) : sequential;
  if (const draco::Status status = decoder.Decode(options, &buffer, mesh.get()); !status.ok())
    refuse(what, "it does not decode (" + status.error_msg_string() + ")");
  return mesh;
}

// An attribute as its accessor wants it, each element on a multiple of four bytes.
class Writer {
 public:
  Writer(const draco::Mesh& mesh, tinygltf::Model& model, std::size_t& bytes_left, std::string what)
      : mesh_(mesh), model_(model), bytes_left_(bytes_left), what_(std::move(what)) {}

  int attribute(int accessor_index, std::size_t id, const std::string& name) {
    const std::string what = what_ + ", " + name;
    if (accessor_index < 0 || static_cast<std::size_t>(accessor_index) >= model_.accessors.size())
      throw SceneError(what + ": there is no accessor " + std::to_string(accessor_index));
    const draco::PointAttribute* attribute = mesh_.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    if (!attribute) refuse(what, "it has no attribute " + std::to_string(id));
    tinygltf::Accessor accessor = model_.accessors[static_cast<std::size_t>(accessor_index)];
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    const int component = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
    if (components < 1 || components > 4 || component < 1) refuse(what, "its accessor is of an unknown type");
    const auto stride = static_cast<std::size_t>(components * component + 3) / 4 * 4;
    std::vector<unsigned char> bytes = take(mesh_.num_points() * stride);
    bool good = true;
    for (std::uint32_t point = 0; point < mesh_.num_points() && good; ++point)
      good = convert(*attribute, attribute->mapped_index(draco::PointIndex(point)), accessor.componentType,
                     components, &bytes[point * stride]);
    if (!good) refuse(what, "it is of another kind than its accessor");
    return add(std::move(accessor), std::move(bytes), mesh_.num_points(), stride);
  }

  int indices() {
    std::vector<unsigned char> bytes = take(std::size_t{mesh_.num_faces()} * 3 * sizeof(std::uint32_t));
    unsigned char* at = bytes.data();
    for (std::uint32_t face = 0; face < mesh_.num_faces(); ++face)
      for (const draco::PointIndex& point : mesh_.face(draco::FaceIndex(face))) {
        const std::uint32_t value = point.value();
        std::memcpy(at, &value, sizeof value);
        at += sizeof value;
      }
    tinygltf::Accessor accessor;
    accessor.type = TINYGLTF_TYPE_SCALAR;
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    return add(std::move(accessor), std::move(bytes), std::size_t{mesh_.num_faces()} * 3, 0);
  }

 private:
  static bool convert(const draco::PointAttribute& from, draco::AttributeValueIndex index, int component_type,
                      int components, unsigned char* to) {
    if (index.value() >= from.size()) return false;
    const auto as = [&]<typename T>(T) {
      std::array<T, 4> values{};
      const bool good = from.ConvertValue<T>(index, static_cast<std::int8_t>(components), values.data());
      std::memcpy(to, values.data(), static_cast<std::size_t>(components) * sizeof(T));
      return good;
    };
    switch (component_type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return as(std::int8_t{});
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return as(std::uint8_t{});
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return as(std::int16_t{});
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return as(std::uint16_t{});
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return as(std::uint32_t{});
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return as(float{});
      default:
        return false;
    }
  }

  std::vector<unsigned char> take(std::size_t bytes) {
    if (bytes == 0) refuse(what_, "it is empty");
    if (bytes > bytes_left_) throw SceneError(what_ + ": the scene's geometry is larger than 1 GiB");
    bytes_left_ -= bytes;
    return std::vector<unsigned char>(bytes);
  }

  int add(tinygltf::Accessor accessor, std::vector<unsigned char> bytes, std::size_t count,
          std::size_t stride) {
    accessor.bufferView = add_view(model_, std::move(bytes));
    model_.bufferViews.back().byteStride = stride;
    accessor.byteOffset = 0;
    accessor.count = count;
    accessor.sparse.isSparse = false;
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  const draco::Mesh& mesh_;
  tinygltf::Model& model_;
  std::size_t& bytes_left_;
  std::string what_;
};

void decompress(tinygltf::Model& model, tinygltf::Primitive& primitive, const tinygltf::Value& extension,
                std::size_t& bytes_left, const std::string& what) {
  const auto mesh =
      decode(bytes_of_view(model, count_of(extension, "bufferView", what), what), bytes_left, what);
  if (!extension.Get("attributes").IsObject()) throw SceneError(what + ": has no attributes");
  const tinygltf::Value& ids = extension.Get("attributes");
  Writer writer(*mesh, model, bytes_left, what);
  for (auto& [name, accessor] : primitive.attributes)
    if (ids.Has(name)) accessor = writer.attribute(accessor, count_of(ids, name.c_str(), what), name);
  primitive.indices = writer.indices();
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
}

}  // namespace

void decompress_draco(tinygltf::Model& model, std::size_t& bytes_left) {
  for (std::size_t m = 0; m < model.meshes.size(); ++m)
    for (std::size_t i = 0; i < model.meshes[m].primitives.size(); ++i) {
      tinygltf::Primitive& primitive = model.meshes[m].primitives[i];
      const auto found = primitive.extensions.find(draco_name);
      if (found == primitive.extensions.end()) continue;
      decompress(model, primitive, found->second, bytes_left,
                 "mesh " + std::to_string(m) + ", primitive " + std::to_string(i) + ": " + draco_name);
      primitive.extensions.erase(draco_name);
    }
}

}  // namespace lichtveld::scene
