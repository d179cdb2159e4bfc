// Textures: their images, and where on them a surface lies.
#pragma once

#include <tiny_gltf.h>

#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {

// Which TEXCOORD set a texture is read by, -1 for no texture, and what is done to its (u, v, 1) first
// (KHR_texture_transform).
struct TextureCoordinates {
  int set = -1;
  glm::dmat3 transform{1};
};

// `what` is the texture's owner in messages. Throws SceneError.
TextureCoordinates coordinates_of(const tinygltf::TextureInfo& info, const std::string& what);

// A texture's sampler, along u and v. Throws SceneError.
std::array<Wrap, 2> wrap_of(const tinygltf::Model& model, const tinygltf::TextureInfo& info,
                            const std::string& what);

// Decodes each image once, however many textures show it.
class TextureReader {
 public:
  explicit TextureReader(const tinygltf::Model& model) : model_(model) {}

  // The index into textures() of what a texture shows. Throws SceneError for what does not decode.
  int read(const tinygltf::TextureInfo& info, const std::string& what);

  std::vector<Texture>& textures() { return textures_; }

 private:
  const tinygltf::Model& model_;
  std::vector<Texture> textures_;
  std::map<int, int> read_;  // image -> texture
  std::size_t pixels_left_ = max_pixels;

  static constexpr std::size_t max_pixels = std::size_t{1} << 26;  // over all textures: 256 MiB of RGBA
};

}  // namespace lichtveld::scene
