// Where rays enter a box, by its slabs (Kay and Kajiya 1986, "Ray Tracing Complex Scenes").
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {

// Arrays of coordinates, or one place for all.
struct Coordinates {
  const float *x, *y, *z;
};

// For each of `count` rays, in lengths of its direction: infinite for those that miss the box. Ray i starts
// between from[i * place_step] and to[i * place_step]; inverse[i * direction_step]: one over its direction.
// Written so that compilers do several at once.
template <std::size_t place_step, std::size_t direction_step>
void enter(const Box& box, std::size_t count, const Coordinates& from, const Coordinates& to,
           const Coordinates& inverse, float* entries) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t p = i * place_step, d = i * direction_step;
    const float ax = (box.min.x - to.x[p]) * inverse.x[d], bx = (box.max.x - from.x[p]) * inverse.x[d],
                ay = (box.min.y - to.y[p]) * inverse.y[d], by = (box.max.y - from.y[p]) * inverse.y[d],
                az = (box.min.z - to.z[p]) * inverse.z[d], bz = (box.max.z - from.z[p]) * inverse.z[d];
    const float first =
        std::max(std::max(std::min(ax, bx), std::min(ay, by)), std::max(std::min(az, bz), 0.0f));
    const float last = std::min(std::min(std::max(ax, bx), std::max(ay, by)), std::max(az, bz));
    entries[i] = first <= last ? first : std::numeric_limits<float>::infinity();
  }
}

}  // namespace lichtveld::scene
