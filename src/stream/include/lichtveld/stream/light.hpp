// Lights that players switch, dim and colour.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace lichtveld::stream {

// What a light gives times what the scene says, in red, green and blue.
using LightScale = std::array<float, 3>;

struct Light {
  std::string name;  // of the scene's node, or "sky"
  LightScale scale = {1, 1, 1};
  bool operator==(const Light&) const = default;
};

// A client's wish.
struct Dimming {
  std::size_t light = 0;  // of the room's, from 0
  LightScale scale = {1, 1, 1};
  bool operator==(const Dimming&) const = default;
};

}  // namespace lichtveld::stream
