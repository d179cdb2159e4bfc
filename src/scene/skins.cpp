#include "skins.hpp"

#include <algorithm>
#include <optional>

#include "accessor.hpp"

namespace lichtveld::scene {

std::span<const glm::dmat4> SkinReader::poses(int skin, const std::string& what) {
  auto found = read_.find(skin);
  if (found == read_.end()) found = read_.emplace(skin, read(skin, what)).first;
  if (found->second.empty())
    remarks_.add("has a skin whose joints are not in the scene; it is ignored", what,
                 "add the skin's joints to the scene, or take the skin off");
  return found->second;
}

std::vector<glm::dmat4> SkinReader::read(int skin, const std::string& what) {
  if (skin < 0 || static_cast<std::size_t>(skin) >= model_.skins.size())
    throw SceneError(what + ": there is no skin " + std::to_string(skin));
  const tinygltf::Skin& in = model_.skins[static_cast<std::size_t>(skin)];
  std::optional<Accessor> inverse_bind;
  if (in.inverseBindMatrices != -1) {
    inverse_bind.emplace(model_, in.inverseBindMatrices,
                         what + ", skin " + std::to_string(skin) + ", inverseBindMatrices");
    inverse_bind->require_matrices();
    if (inverse_bind->count() < in.joints.size())
      throw SceneError(what + ", skin " + std::to_string(skin) + ": fewer inverseBindMatrices than joints");
  }
  std::vector<glm::dmat4> result;
  for (std::size_t i = 0; i < in.joints.size(); ++i) {
    const auto joint = std::ranges::lower_bound(nodes_, in.joints[i], {}, &PlacedNode::node);
    if (joint == nodes_.end() || joint->node != in.joints[i]) return {};
    result.push_back(inverse_bind ? joint->world * glm::dmat4(inverse_bind->mat4(i)) : joint->world);
  }
  return result;
}

}  // namespace lichtveld::scene
