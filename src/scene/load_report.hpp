// What load() finds out besides the scene.
#pragma once

#include <optional>
#include <vector>

#include "lichtveld/scene/check.hpp"
#include "lichtveld/scene/scene.hpp"
#include "lichtveld/scene/unwrap.hpp"
#include "remarks.hpp"

namespace tinygltf {
class Model;
}

namespace lichtveld::scene {

// Of Scene::vertices, before textures cut them into even pieces.
struct WholeTriangles {
  std::vector<Surface> surfaces;  // whose indices are these, not the scene's
  std::vector<std::uint32_t> indices;
};

// For check().
struct LoadDetails {
  std::vector<MeshFacts> meshes;
  WholeTriangles whole;
};

struct LoadReport {
  Remarks remarks;
  std::optional<Unwrapped> unwrapped;  // without its bytes, which are Scene::unwrapped
  LoadDetails* details = nullptr;      // to be filled, if there
};

// As load(), but tells nothing of what it returns.
Scene load(const std::filesystem::path& file, const LoadOptions& options, LoadReport& report);

// What the meshes of the scene's nodes are, by node.
std::vector<MeshFacts> mesh_facts(const tinygltf::Model& model);

}  // namespace lichtveld::scene
