#include "textures.hpp"

#include <cmath>
#include <span>

#include "image.hpp"

namespace lichtveld::scene {
namespace {

const tinygltf::Texture& texture_of(const tinygltf::Model& model, const tinygltf::TextureInfo& info,
                                    const std::string& what) {
  if (info.index < 0) throw SceneError(what + ": there is no texture with a negative index");
  if (static_cast<std::size_t>(info.index) >= model.textures.size())
    throw SceneError(what + ": there is no texture " + std::to_string(info.index));
  return model.textures[static_cast<std::size_t>(info.index)];
}

// What turns a texture in a format that is not read into one that is.
std::string conversion_of(const std::string& extension) {
  const char* command = extension == "KHR_texture_basisu" ? "ktxdecompress" : "png";
  return std::string("convert it with npx @gltf-transform/cli ") + command + " in.glb out.glb";
}

// The image that a texture shows. Where it has one for every reader, that one.
int source_of(const tinygltf::Texture& texture, const std::string& what) {
  if (texture.source >= 0) return texture.source;
  constexpr const char* webp = "EXT_texture_webp";
  if (const auto found = texture.extensions.find(webp); found != texture.extensions.end()) {
    const bool has = found->second.IsObject() && found->second.Has("source");
    if (!has || !found->second.Get("source").IsInt()) throw SceneError(what + ": " + webp + " has no source");
    return found->second.Get("source").GetNumberAsInt();
  }
  for (const auto& [name, value] : texture.extensions)
    if (value.IsObject() && value.Has("source"))
      throw SceneError(what + " is there by " + name + " alone, which is not read; " + conversion_of(name));
  return -1;
}

// Two numbers of KHR_texture_transform.
glm::dvec2 pair_of(const tinygltf::Value& transform, const char* key, glm::dvec2 otherwise,
                   const std::string& what) {
  if (!transform.Has(key)) return otherwise;
  const tinygltf::Value& value = transform.Get(key);
  if (!value.IsArray() || value.ArrayLen() != 2 || !value.Get(0).IsNumber() || !value.Get(1).IsNumber())
    throw SceneError(what + ": " + key + " is no pair of numbers");
  return {value.Get(0).GetNumberAsDouble(), value.Get(1).GetNumberAsDouble()};
}

}  // namespace

TextureCoordinates coordinates_of(const tinygltf::TextureInfo& info, const std::string& what) {
  TextureCoordinates result{.set = info.texCoord};
  constexpr const char* extension = "KHR_texture_transform";
  const auto found = info.extensions.find(extension);
  if (found != info.extensions.end() && found->second.IsObject()) {
    const tinygltf::Value& transform = found->second;
    const std::string where = what + ": " + extension;
    const glm::dvec2 offset = pair_of(transform, "offset", glm::dvec2(0), where);
    const glm::dvec2 scale = pair_of(transform, "scale", glm::dvec2(1), where);
    double angle = 0;  // counter-clockwise as the image is seen, with v down [rad]
    if (transform.Has("rotation")) {
      if (!transform.Get("rotation").IsNumber()) throw SceneError(where + ": rotation is no number");
      angle = transform.Get("rotation").GetNumberAsDouble();
    }
    if (transform.Has("texCoord")) {
      if (!transform.Get("texCoord").IsInt()) throw SceneError(where + ": texCoord is no whole number");
      result.set = transform.Get("texCoord").GetNumberAsInt();
    }
    const double c = std::cos(angle), s = std::sin(angle);
    result.transform = {{c * scale.x, -s * scale.x, 0}, {s * scale.y, c * scale.y, 0}, {offset.x, offset.y, 1}};
  }
  if (result.set < 0) throw SceneError(what + ": its texture has a negative texCoord");
  return result;
}

std::array<Wrap, 2> wrap_of(const tinygltf::Model& model, const tinygltf::TextureInfo& info,
                            const std::string& what) {
  const int sampler = texture_of(model, info, what).sampler;
  if (sampler == -1) return {Wrap::repeat, Wrap::repeat};
  if (sampler < 0 || static_cast<std::size_t>(sampler) >= model.samplers.size())
    throw SceneError(what + ": there is no sampler " + std::to_string(sampler));
  const auto wrap = [&](int mode) {
    switch (mode) {
      case TINYGLTF_TEXTURE_WRAP_REPEAT:
        return Wrap::repeat;
      case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return Wrap::mirror;
      case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return Wrap::clamp;
      default:
        throw SceneError(what + ": sampler " + std::to_string(sampler) + " has the unknown wrap mode " +
                         std::to_string(mode));
    }
  };
  const auto& found = model.samplers[static_cast<std::size_t>(sampler)];
  return {wrap(found.wrapS), wrap(found.wrapT)};
}

int TextureReader::read(const tinygltf::TextureInfo& info, const std::string& what) {
  const std::string texture = what + ": texture " + std::to_string(info.index);
  const int source = source_of(texture_of(model_, info, what), texture);
  if (source < 0 || static_cast<std::size_t>(source) >= model_.images.size()) {
    throw SceneError(texture + " has no image " + std::to_string(source) + "; PNG, JPEG and WebP are read");
  }
  if (const auto known = read_.find(source); known != read_.end()) return known->second;
  const tinygltf::Image& image = model_.images[static_cast<std::size_t>(source)];
  std::string name = what + ": image " + std::to_string(source);
  if (!image.uri.empty()) name += " (" + image.uri + ")";
  const auto bytes = encoded_bytes(model_, image);
  if (bytes.empty()) throw SceneError(name + " is missing: put it beside the scene, or export one .glb");
  textures_.push_back(decode_image(bytes, pixels_left_, name));
  pixels_left_ -= textures_.back().rgba.size() / 4;
  return read_[source] = static_cast<int>(textures_.size()) - 1;
}

}  // namespace lichtveld::scene
