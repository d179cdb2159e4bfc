// Encoded pictures to pixels.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {

// Decodes a PNG, JPEG or WebP to 8-bit sRGB RGBA. `what` names the image in messages. Throws SceneError for
// what does not decode, or has more than `max_pixels` pixels (looked up in its header, before anything is
// allocated).
Texture decode_image(std::span<const unsigned char> bytes, std::size_t max_pixels, const std::string& what);

}  // namespace lichtveld::scene
