// Materials, and the textures that their base colours ask for.
#include <spdlog/spdlog.h>

#include <cmath>
#include <map>
#include <span>

#include "image.hpp"
#include "parts.hpp"

namespace lichtveld::scene {
namespace {

constexpr std::size_t max_pixels = std::size_t{1} << 26;  // over all textures: 256 MiB of RGBA

constexpr const char* strength_extension = "KHR_materials_emissive_strength";

// Where an image's encoded bytes lie. The buffer views were checked against their buffers before.
std::span<const unsigned char> encoded(const tinygltf::Model& model, const tinygltf::Image& image) {
  if (image.bufferView < 0) return image.image;
  const auto& view = model.bufferViews[static_cast<std::size_t>(image.bufferView)];
  const auto& buffer = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  return std::span(buffer).subspan(view.byteOffset, view.byteLength);
}

glm::vec3 colour(const std::vector<double>& rgb, double scale, double most, const std::string& what) {
  glm::dvec3 value(1);
  for (int c = 0; c < 3; ++c) {
    value[c] = rgb[static_cast<std::size_t>(c)] * scale;
    if (!(value[c] >= 0 && value[c] <= most))
      throw SceneError(what + " is outside 0.." + (most > 1 ? "1e6" : "1"));
  }
  return value;
}

double emissive_strength(const tinygltf::Material& material, const std::string& what) {
  const auto found = material.extensions.find(strength_extension);
  if (found == material.extensions.end()) return 1;
  const tinygltf::Value& strength = found->second.Get("emissiveStrength");
  if (!strength.IsNumber()) throw SceneError(what + ": emissiveStrength is no number");
  return strength.GetNumberAsDouble();
}

// Decodes each image once, however many textures show it.
class TextureReader {
 public:
  TextureReader(const tinygltf::Model& model, std::vector<Texture>& textures)
      : model_(model), textures_(textures) {}

  int read(int index, const std::string& what) {
    if (static_cast<std::size_t>(index) >= model_.textures.size()) {
      throw SceneError(what + ": there is no texture " + std::to_string(index));
    }
    const int source = model_.textures[static_cast<std::size_t>(index)].source;
    if (source < 0 || static_cast<std::size_t>(source) >= model_.images.size()) {
      throw SceneError(what + ": texture " + std::to_string(index) + " has no image " + std::to_string(source) +
                       "; PNG and JPEG are supported");
    }
    if (const auto known = read_.find(source); known != read_.end()) return known->second;
    const tinygltf::Image& image = model_.images[static_cast<std::size_t>(source)];
    std::string name = "image " + std::to_string(source);
    if (!image.uri.empty()) name += " (" + image.uri + ")";
    const auto bytes = encoded(model_, image);
    if (bytes.empty()) throw SceneError(name + " is missing: put it beside the scene, or export one .glb");
    textures_.push_back(decode_image(bytes, pixels_left_, name));
    pixels_left_ -= textures_.back().rgba.size() / 4;
    return read_[source] = static_cast<int>(textures_.size()) - 1;
  }

 private:
  const tinygltf::Model& model_;
  std::vector<Texture>& textures_;
  std::map<int, int> read_;  // image -> texture
  std::size_t pixels_left_ = max_pixels;
};

}  // namespace

Materials read_materials(const tinygltf::Model& model) {
  Materials result;
  TextureReader reader(model, result.textures);
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const tinygltf::Material& in = model.materials[i];
    const tinygltf::PbrMetallicRoughness& pbr = in.pbrMetallicRoughness;
    Material out;
    out.name = in.name.empty() ? "material " + std::to_string(i) : in.name;
    const std::string what = "material \"" + out.name + "\"";
    out.base_colour = colour(pbr.baseColorFactor, 1, 1, what + ": baseColorFactor");
    out.emission = colour(in.emissiveFactor, emissive_strength(in, what), 1e6,
                          what + ": emissiveFactor * " + strength_extension);
    out.double_sided = in.doubleSided;
    int set = -1;
    if (pbr.baseColorTexture.index != -1) {
      if (pbr.baseColorTexture.index < 0)
        throw SceneError(what + ": there is no texture with a negative index");
      out.texture = reader.read(pbr.baseColorTexture.index, what);
      set = pbr.baseColorTexture.texCoord;
      if (set < 0) throw SceneError(what + ": baseColorTexture has a negative texCoord");
      if (pbr.baseColorTexture.extensions.contains("KHR_texture_transform")) {
        spdlog::warn("{}: KHR_texture_transform is ignored; bake it into the texture coordinates", what);
      }
    }
    if (in.emissiveTexture.index != -1)
      spdlog::warn("{}: emissiveTexture is ignored, the whole surface emits", what);
    if (in.alphaMode != "OPAQUE")
      spdlog::warn("{}: alphaMode {} is ignored, the surface is opaque", what, in.alphaMode);
    result.materials.push_back(std::move(out));
    result.colour_set.push_back(set);
  }
  Material standard;
  standard.name = "default";
  result.materials.push_back(standard);
  result.colour_set.push_back(-1);
  return result;
}

}  // namespace lichtveld::scene
