#include "image.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <webp/decode.h>

#include <algorithm>
#include <string_view>

#include "model.hpp"

namespace lichtveld::scene {
namespace {

bool holds(std::span<const unsigned char> bytes, std::size_t at, std::string_view text) {
  return bytes.size() >= at + text.size() &&
         std::equal(text.begin(), text.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    [](char a, unsigned char b) { return static_cast<unsigned char>(a) == b; });
}

// Without pixels yet, but with room for them.
Texture texture_of(std::size_t width, std::size_t height, std::size_t max_pixels, const std::string& what) {
  if (width * height > max_pixels)
    throw SceneError(what + ", of " + std::to_string(width * height) +
                     " pixels, is too large: 64 million are allowed over all textures");
  Texture texture;
  texture.width = static_cast<std::uint32_t>(width);
  texture.height = static_cast<std::uint32_t>(height);
  texture.rgba.resize(4 * width * height);
  return texture;
}

// By its own library: OpenImageIO multiplies colours by alpha, and the pixels of a hole are lost.
Texture decode_webp(std::span<const unsigned char> bytes, std::size_t max_pixels, const std::string& what) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK || features.has_animation)
    throw SceneError(what + " does not decode: a damaged or moving WebP");
  Texture texture = texture_of(static_cast<std::size_t>(features.width),
                               static_cast<std::size_t>(features.height), max_pixels, what);
  if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), texture.rgba.data(), texture.rgba.size(),
                          4 * features.width))
    throw SceneError(what + " does not decode: a damaged WebP");
  return texture;
}

}  // namespace

std::span<const unsigned char> encoded_bytes(const tinygltf::Model& model, const tinygltf::Image& image) {
  if (image.bufferView < 0) return image.image;
  return bytes_of_view(model, static_cast<std::size_t>(image.bufferView), "an image");
}

const char* format_of(std::span<const unsigned char> bytes) {
  if (holds(bytes, 0, "\x89PNG")) return "png";
  if (holds(bytes, 0, "\xff\xd8\xff")) return "jpeg";
  if (holds(bytes, 0, "RIFF") && holds(bytes, 8, "WEBP")) return "webp";
  if (holds(bytes, 1, "KTX 2")) return "ktx2";
  return nullptr;
}

Texture decode_image(std::span<const unsigned char> bytes, std::size_t max_pixels, const std::string& what) {
  const char* format = format_of(bytes);
  const std::string_view name = format ? format : "";
  if (name == "webp") return decode_webp(bytes, max_pixels, what);
  if (name == "ktx2")
    throw SceneError(what +
                     " is a KTX2, which is not read; convert it with npx @gltf-transform/cli "
                     "ktxdecompress in.glb out.glb");
  if (!format) throw SceneError(what + " is no PNG, JPEG or WebP");

  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;
  // By the format's name only that reader is tried; by a file's name every one would be.
  const auto input = OIIO::ImageInput::create(format);
  OIIO::ImageSpec spec;
  if (!input) throw SceneError(what + " cannot be read: OpenImageIO has no reader for " + format);
  if (!input->set_ioproxy(&memory) || !input->open("memory", spec, config)) {
    const std::string reason = input->geterror();
    throw SceneError(what + " does not decode: " + reason);
  }
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.nchannels > 4) {
    throw SceneError(what + " has no pixels of 1 to 4 channels");
  }
  Texture texture =
      texture_of(static_cast<std::size_t>(spec.width), static_cast<std::size_t>(spec.height), max_pixels, what);
  const std::size_t pixels = texture.rgba.size() / 4;
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  std::vector<std::uint8_t> raw(pixels * channels);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, raw.data())) {
    const std::string reason = input->geterror();
    throw SceneError(what + " does not decode: " + reason);
  }
  const bool grey = channels < 3;
  const bool alpha = channels == 2 || channels == 4;
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < 3; ++c) texture.rgba[4 * i + c] = raw[channels * i + (grey ? 0 : c)];
    texture.rgba[4 * i + 3] = alpha ? raw[channels * i + channels - 1] : 255;
  }
  return texture;
}

}  // namespace lichtveld::scene
