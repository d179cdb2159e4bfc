// A room of any number of triangles, as a file, for measuring what depends on how many there are.
#pragma once

#include <cstdint>
#include <string>

namespace lichtveld::bench {

// glTF binary: a closed room with a lamp, whose floor is a height field of about so many triangles, at least 2;
// "cube", of 12 triangles, and "ball", of 5,000, are movable.
std::string scale_room(std::uint32_t triangles);

}  // namespace lichtveld::bench
