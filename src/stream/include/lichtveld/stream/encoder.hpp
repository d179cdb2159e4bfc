// Light maps to PNG bytes in memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lichtveld::stream {

// Longest side of a map [pixels]: what every WebGL2 device takes as a texture, and then some.
inline constexpr std::uint32_t max_png_size = 8192;

// Encodes size * size 8-bit sRGB RGBA pixels (row 0 on top; alpha is dropped) as an RGB PNG, marked sRGB. size
// is 1 .. max_png_size; `compression` is zlib's level 0 .. 9; 1 is 4 times faster than 6 at 1.4 times the
// bytes. Throws std::runtime_error for other arguments (the message names them) and when the encoder fails.
// Thread-safe.
std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> rgba, std::uint32_t size,
                                     int compression = 1);

}  // namespace lichtveld::stream
