// What extensions a file requires, before tinygltf sees it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "remarks.hpp"

namespace lichtveld::scene {

// Remarks on required extensions that are unknown, and whose part of the light is left out. Throws SceneError
// where geometry is there by such an extension alone.
void check_extensions(const nlohmann::json& root, Remarks& remarks);

}  // namespace lichtveld::scene
