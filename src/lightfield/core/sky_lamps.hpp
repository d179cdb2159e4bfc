// The sky as lamps: 32 triangles of an octahedron, far away, each of which shines as what it hides of the sky.
#pragma once

#include <cstdint>
#include <vector>

#include "core/area_lamps.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

// Those that are not dark, around a scene, with samples of so many sets: all sets together are as evenly spread
// as one.
std::vector<AreaLamp> sky_lamps(const scene::Sky& sky, const scene::Sphere& around, std::uint32_t sets);

}  // namespace lichtveld::lightfield
