// OpenEXR takes memory for what a file's header says of itself, before it looks whether the file is so long.
#pragma once

#include <filesystem>
#include <string>

namespace lichtveld::scene {

// Throws SceneError, which begins with `what`, for an OpenEXR file whose header claims more than the file
// holds.
void check_exr_header(const std::filesystem::path& file, const std::string& what);

}  // namespace lichtveld::scene
