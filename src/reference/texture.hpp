// A texture's colour at a place.
#pragma once

#include <glm/glm.hpp>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::reference {

// Linear RGB, decoded from sRGB before the bilinear filter, as graphics hardware does it; repeating. `at` is
// glTF's texture coordinate: (0, 0) is the upper left corner of the first pixel.
glm::vec3 sample_srgb(const scene::Texture& texture, glm::vec2 at);

}  // namespace lichtveld::reference
