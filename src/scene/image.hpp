// Encoded pictures to pixels.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <span>
#include <string>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {

// Where an image's encoded bytes lie; none where its file is missing.
std::span<const unsigned char> encoded_bytes(const tinygltf::Model& model, const tinygltf::Image& image);

// "png", "jpeg", "webp" or "ktx2" by their first bytes; null for anything else.
const char* format_of(std::span<const unsigned char> bytes);

// Decodes a PNG, JPEG or WebP to 8-bit sRGB RGBA. `what` names the image in messages. Throws SceneError for
// what does not decode, or has more than `max_pixels` pixels (looked up in its header, before anything is
// allocated).
Texture decode_image(std::span<const unsigned char> bytes, std::size_t max_pixels, const std::string& what);

}  // namespace lichtveld::scene
