// What players see of a room's light.
#pragma once

#include <cstdint>
#include <vector>

namespace lichtveld::lightfield {

// A map of size * size texels, row 0 on top, in one of these formats.
struct Shown {
  enum class Format {
    srgb8,  // tone-mapped L, sRGB, RGBA of 8 bits each; gutters filled from their charts, black beyond them
  };
  Format format = Format::srgb8;
  std::uint32_t size = 0;
  std::vector<std::uint8_t> bytes = {};
};

}  // namespace lichtveld::lightfield
