// Skins at the pose that the node tree shows.
#pragma once

#include <tiny_gltf.h>

#include <glm/glm.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "parts.hpp"

namespace lichtveld::scene {

// Reads each skin once, however many nodes wear it.
class SkinReader {
 public:
  SkinReader(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes, Remarks& remarks)
      : model_(model), nodes_(nodes), remarks_(remarks) {}

  // What takes a vertex that follows a joint alone into the world, for each joint. Nothing, and a remark, where
  // a joint is not in the scene. `what` names the node that wears the skin. Throws SceneError.
  std::span<const glm::dmat4> poses(int skin, const std::string& what);

 private:
  std::vector<glm::dmat4> read(int skin, const std::string& what);

  const tinygltf::Model& model_;
  const std::vector<PlacedNode>& nodes_;
  Remarks& remarks_;
  std::map<int, std::vector<glm::dmat4>> read_;
};

}  // namespace lichtveld::scene
