// What a texel reflects: the mean over its surface, for a texture may have many pixels in it.
#pragma once

#include <vector>

#include "core/texel_records.hpp"

namespace lichtveld::lightfield {

// Sets the albedo of records, which are `size` texels a side of an atlas, to the mean over those parts of their
// surfaces' charts that lie in the texel. A surface of one colour everywhere keeps it.
void average_albedo(const scene::Scene& scene, std::uint32_t size, std::vector<TexelRecord>& records);

// The mean over a triangle of a surface, 0..1, linear.
glm::vec3 mean_albedo(const scene::Scene& scene, std::uint32_t surface, std::uint32_t triangle);

}  // namespace lichtveld::lightfield
