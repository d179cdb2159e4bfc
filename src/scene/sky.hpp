// The sky from options, extras and files. All throw SceneError without the scene's name.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {

struct FoundSky {
  Sky sky;
  std::vector<PunctualLight>
      suns;  // what was far brighter than its surroundings, and is not in the sky any more
};

// "R,G,B" or a file, as in LoadOptions::sky.
FoundSky sky_of(const std::string& text);

// The name of the file that extras.sky names; empty where it names none.
std::string sky_file_of(const tinygltf::Value& extras);

// What the model's scene of that number says: extras.sky ([R, G, B] or the name of a file in `folder`), or
// EXT_lights_image_based by its coefficients.
std::optional<FoundSky> find_sky(const tinygltf::Model& model, int scene, const std::filesystem::path& folder);

}  // namespace lichtveld::scene
