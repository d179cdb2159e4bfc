// A sound scene, ways to spoil it, and what load() says then.
#pragma once

#include <gmock/gmock.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lichtveld/scene/scene.hpp"
#include "scene_features.hpp"

namespace lichtveld::scene {

using testing::accessor_json;
using testing::attributes;
using testing::overwrite;
using testing::SceneBuilder;
using testing::sound;
using testing::TempFolder;

inline std::string error_of(const std::filesystem::path& file) {
  try {
    load(file);
  } catch (const SceneError& e) {
    return e.what();
  }
  return "no error";
}

inline std::string error_of_bytes(const std::string& bytes, const std::string& name = "scene.glb") {
  const TempFolder folder;
  return error_of(folder.write(name, bytes));
}

inline Scene loaded(const SceneBuilder& builder) {
  const TempFolder folder;
  return load(folder.write("scene.glb", builder.glb()));
}

struct SpoiltCase {
  const char* name;
  std::function<void(SceneBuilder&)> spoil;
  const char* message;
};

// Each of the cases is refused with its message.
inline void expect_refused(const SceneBuilder& sound_one, const std::vector<SpoiltCase>& cases) {
  for (const SpoiltCase& bad : cases) {
    SceneBuilder builder = sound_one;
    bad.spoil(builder);
    EXPECT_THAT(error_of_bytes(builder.glb()), ::testing::HasSubstr(bad.message)) << bad.name;
  }
}

}  // namespace lichtveld::scene
