// A triangle by its corners.
#pragma once

#include <array>
#include <glm/glm.hpp>

namespace lichtveld::scene {

using Corners = std::array<glm::vec3, 3>;  // [m]

// The cross product of its edges from the first corner: along its face, twice its area long.
glm::dvec3 cross_of(const Corners& corners);

// [m2]
double area_of(const Corners& corners);

// Whether it has a normal worth the name: less high than a share of its longest edge, it is a line. A 32-bit
// coordinate as long as the edge is rounded by as much.
bool has_area(const Corners& corners);

// Whether two have the same corners in the same order, whichever is the first: such copies may share texels.
bool are_copies(const Corners& a, const Corners& b);

}  // namespace lichtveld::scene
