// A room of any number of triangles, as a file, for measuring what depends on how many there are.
#pragma once

#include <cstdint>
#include <string>

namespace lichtveld::bench {

// glTF binary: a closed room, whose floor is a height field of about so many triangles, at least 2; "cube", of
// 12 triangles, and "ball", of 5,000, are movable. Its lamp is a square below the ceiling, `lamp` as wide as
// that (0..1), and of the same power however wide.
std::string scale_room(std::uint32_t triangles, float lamp);

}  // namespace lichtveld::bench
