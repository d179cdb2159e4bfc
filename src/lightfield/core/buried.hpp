// Which places are buried, by rays.
#pragma once

#include <span>
#include <vector>

#include "core/texel_records.hpp"
#include "lichtveld/lightfield/buried.hpp"
#include "lichtveld/scene/ray_index.hpp"

namespace lichtveld::lightfield {

// 1 for each place from which rays meet no fronts of what stands still but backs: it is inside of something. In
// a scene without a sky some may meet nothing. Bodies are at rest.
std::vector<char> find_buried(const scene::RayIndex& index, const scene::Scene& scene,
                              std::span<const TexelRecord> places);

}  // namespace lichtveld::lightfield
