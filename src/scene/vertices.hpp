// Where a primitive's vertices are: morphed by their mesh's weights, placed by their node or by the joints of
// its skin.
#pragma once

#include <tiny_gltf.h>

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "accessor.hpp"
#include "parts.hpp"

namespace lichtveld::scene {

// From a mesh's space into the world's.
struct Transform {
  explicit Transform(const glm::dmat4& of);

  glm::dmat4 world;
  bool mirrored;  // fronts are backs then
  glm::dmat3
      cofactors;  // for normals: the inverse transpose up to a positive factor, for singular matrices too
};

// Throws SceneError where vertex `i` is nowhere, or so far that 32-bit positions are coarser than 6 cm: such
// scenes have their unit wrong.
void check_place(const glm::dvec3& place, std::size_t i, const std::string& what);

class Vertices {
 public:
  // `what` is the primitive in messages. Throws SceneError.
  Vertices(const tinygltf::Model& model, const tinygltf::Primitive& primitive, const Placement& placement,
           const std::string& what);

  std::size_t count() const { return positions_.count(); }
  bool has_normals() const { return normals_.has_value(); }

  // Of vertex i < count(), in the mesh's space. Normals have any length.
  glm::dvec3 position(std::size_t i) const;
  glm::dvec3 normal(std::size_t i) const;
  Transform transform(std::size_t i) const;

 private:
  // A morph target that counts.
  struct Target {
    double weight;
    std::optional<Accessor> positions, normals;
  };
  // Four joints of each vertex, and their weights.
  struct Joints {
    Accessor joints, weights;
  };

  void read_targets(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                    std::span<const double> weights);
  void read_joints(const tinygltf::Model& model, const tinygltf::Primitive& primitive);
  std::optional<Accessor> vectors(const tinygltf::Model& model, const std::map<std::string, int>& attributes,
                                  const std::string& name, int components, const std::string& what) const;

  std::string what_;
  Accessor positions_;
  std::optional<Accessor> normals_;
  std::vector<Target> targets_;
  std::vector<Joints> joints_;
  std::span<const glm::dmat4> poses_;  // of the skin's joints
  Transform node_;
};

}  // namespace lichtveld::scene
