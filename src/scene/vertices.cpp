#include "vertices.hpp"

#include <algorithm>
#include <cmath>

namespace lichtveld::scene {
namespace {

Accessor positions_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                      const std::string& what) {
  const auto found = primitive.attributes.find("POSITION");
  if (found == primitive.attributes.end()) throw SceneError(what + " has no POSITION");
  Accessor positions(model, found->second, what + ", POSITION");
  positions.require_vectors(3);
  return positions;
}

}  // namespace

void check_place(const glm::dvec3& place, std::size_t i, const std::string& what) {
  constexpr double farthest = 1e6;
  for (int c = 0; c < 3; ++c)
    if (!(std::abs(place[c]) <= farthest))
      throw SceneError(what + ": vertex " + std::to_string(i) +
                       " is not finite or more than 1000 km away; positions are in metres");
}

Transform::Transform(const glm::dmat4& of) : world(of) {
  const glm::dmat3 m(world);
  mirrored = glm::determinant(m) < 0;
  const double side = mirrored ? -1 : 1;
  cofactors = {side * glm::cross(m[1], m[2]), side * glm::cross(m[2], m[0]), side * glm::cross(m[0], m[1])};
}

Vertices::Vertices(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                   const Placement& placement, const std::string& what)
    : what_(what), positions_(positions_of(model, primitive, what)), node_(placement.world) {
  normals_ = vectors(model, primitive.attributes, "NORMAL", 3, what);
  read_targets(model, primitive, placement.weights);
  if (placement.poses.empty()) return;
  read_joints(model, primitive);
  if (!joints_.empty()) poses_ = placement.poses;
}

void Vertices::read_targets(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                            std::span<const double> weights) {
  for (std::size_t i = 0; i < std::min(weights.size(), primitive.targets.size()); ++i) {
    if (weights[i] == 0) continue;
    const std::string what = what_ + ", target " + std::to_string(i);
    Target target{weights[i], vectors(model, primitive.targets[i], "POSITION", 3, what), {}};
    if (normals_) target.normals = vectors(model, primitive.targets[i], "NORMAL", 3, what);
    targets_.push_back(std::move(target));
  }
}

void Vertices::read_joints(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
  for (int set = 0;; ++set) {
    const std::string number = std::to_string(set);
    auto joints = vectors(model, primitive.attributes, "JOINTS_" + number, 4, what_);
    auto weights = vectors(model, primitive.attributes, "WEIGHTS_" + number, 4, what_);
    if (!joints && !weights) return;
    if (!joints || !weights)
      throw SceneError(what_ + " has only one of JOINTS_" + number + " and WEIGHTS_" + number);
    joints_.push_back({std::move(*joints), std::move(*weights)});
  }
}

// An attribute of as many elements as there are positions, if it is there.
std::optional<Accessor> Vertices::vectors(const tinygltf::Model& model,
                                          const std::map<std::string, int>& attributes, const std::string& name,
                                          int components, const std::string& what) const {
  const auto found = attributes.find(name);
  if (found == attributes.end()) return std::nullopt;
  Accessor accessor(model, found->second, what + ", " + name);
  accessor.require_vectors(components);
  if (accessor.count() < count()) throw SceneError(what + ": " + name + " has fewer elements than POSITION");
  return accessor;
}

glm::dvec3 Vertices::position(std::size_t i) const {
  glm::dvec3 result = positions_.vec3(i);
  for (const Target& target : targets_)
    if (target.positions) result += target.weight * glm::dvec3(target.positions->vec3(i));
  return result;
}

glm::dvec3 Vertices::normal(std::size_t i) const {
  glm::dvec3 result = normals_->vec3(i);
  for (const Target& target : targets_)
    if (target.normals) result += target.weight * glm::dvec3(target.normals->vec3(i));
  return result;
}

Transform Vertices::transform(std::size_t i) const {
  if (poses_.empty()) return node_;
  const auto pose = [&](float joint) -> const glm::dmat4& {
    // Written so that what is no number is refused too.
    if (!(joint >= 0 && joint < static_cast<float>(poses_.size())))
      throw SceneError(what_ + ": vertex " + std::to_string(i) + " follows joint " +
                       std::to_string(std::lround(joint)) + " of " + std::to_string(poses_.size()));
    return poses_[static_cast<std::size_t>(joint)];
  };
  glm::dmat4 sum(0);
  double total = 0;
  for (const Joints& set : joints_) {
    const glm::vec4 joints = set.joints.vec4(i), weights = set.weights.vec4(i);
    for (int k = 0; k < 4; ++k) {
      if (weights[k] == 0) continue;
      if (!(weights[k] > 0 && std::isfinite(weights[k])))
        throw SceneError(what_ + ": a weight of vertex " + std::to_string(i) + " is no number of 0 or more");
      sum += static_cast<double>(weights[k]) * pose(joints[k]);
      total += weights[k];
    }
  }
  if (total == 0) return Transform(pose(joints_[0].joints.vec4(i)[0]));
  return Transform(sum / total);  // exporters round weights, and their sum is not quite 1
}

}  // namespace lichtveld::scene
