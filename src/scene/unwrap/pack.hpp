#pragma once

#include <cstdint>
#include <vector>

namespace lichtveld::scene {

struct Rectangle {
  std::uint32_t width = 0, height = 0;  // > 0
  std::uint32_t x = 0, y = 0;           // where it was put
};

// Puts rectangles into a square without overlaps; the same for the same. False, with places that mean nothing,
// where no room was found.
bool pack(std::vector<Rectangle>& rectangles, std::uint32_t size);

}  // namespace lichtveld::scene
