// A sound scene, ways to spoil it, and what load() says then.
#pragma once

#include <gmock/gmock.h>

#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lichtveld/scene/scene.hpp"
#include "scene_builder.hpp"

namespace lichtveld::scene {

using testing::SceneBuilder;
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

// A floor and a child node; accessors: 0 POSITION, 1 TEXCOORD_1, 2 indices.
inline SceneBuilder sound() {
  SceneBuilder builder;
  builder.quad("floor", {glm::vec3{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}, {0.1f, 0.1f, 0.9f, 0.9f},
               builder.material({0.5f, 0.5f, 0.5f}, {1, 1, 1}));
  builder.gltf["nodes"].push_back({{"name", "child"}});
  builder.gltf["nodes"][0]["children"] = {1};
  return builder;
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

template <typename T>
void overwrite(SceneBuilder& builder, std::size_t accessor, std::size_t element, T value) {
  const nlohmann::json& view =
      builder.gltf["bufferViews"][builder.gltf["accessors"][accessor]["bufferView"].get<std::size_t>()];
  std::memcpy(&builder.bin.at(view["byteOffset"].get<std::size_t>() + element * sizeof value), &value,
              sizeof value);
}

inline nlohmann::json& accessor_json(SceneBuilder& builder, int accessor) {
  return builder.gltf["accessors"][static_cast<std::size_t>(accessor)];
}

inline nlohmann::json& attributes(SceneBuilder& b) {
  return b.primitive(0)["attributes"];
}

}  // namespace lichtveld::scene
