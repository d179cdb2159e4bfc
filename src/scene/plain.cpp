#include "plain.hpp"

#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "accessor.hpp"
#include "lichtveld/scene/scene.hpp"
#include "model.hpp"

namespace lichtveld::scene {
namespace {

constexpr const char* instancing = "EXT_mesh_gpu_instancing";
constexpr std::size_t max_instances = 100'000;  // over all nodes: each becomes a node and a surface

void show_indices(tinygltf::Model& model) {
  for (tinygltf::Mesh& mesh : model.meshes)
    for (tinygltf::Primitive& primitive : mesh.primitives)
      if (const auto hidden = primitive.attributes.extract(hidden_indices)) primitive.indices = hidden.mapped();
}

void add_scene(tinygltf::Model& model) {
  if (!model.scenes.empty()) return;
  std::set<int> children;
  for (const tinygltf::Node& node : model.nodes) children.insert(node.children.begin(), node.children.end());
  tinygltf::Scene scene;
  for (int node = 0; node < static_cast<int>(model.nodes.size()); ++node)
    if (!children.contains(node)) scene.nodes.push_back(node);
  model.scenes.push_back(scene);
}

// Where a node's instances stand: accessors of as many elements, each of which may be absent.
struct Instances {
  std::optional<Accessor> translation, rotation, scale;
  std::size_t count = 0;
};

std::optional<Accessor> instance_attribute(const tinygltf::Model& model, const tinygltf::Value& attributes,
                                           const char* name, int components, Instances& instances,
                                           const std::string& what) {
  if (!attributes.Has(name)) return std::nullopt;
  const tinygltf::Value& index = attributes.Get(name);
  if (!index.IsInt()) throw SceneError(what + ": " + name + " is no accessor");
  Accessor accessor(model, index.GetNumberAsInt(), what + ", " + name);
  accessor.require_vectors(components);
  if (instances.count != 0 && accessor.count() != instances.count)
    throw SceneError(what + ": " + name + " is of " + std::to_string(accessor.count()) +
                     " instances, another of " + std::to_string(instances.count));
  instances.count = accessor.count();
  return accessor;
}

Instances instances_of(const tinygltf::Model& model, const tinygltf::Value& extension,
                       const std::string& what) {
  if (!extension.IsObject() || !extension.Get("attributes").IsObject())
    throw SceneError(what + ": has no attributes");
  const tinygltf::Value& attributes = extension.Get("attributes");
  Instances result;
  result.translation = instance_attribute(model, attributes, "TRANSLATION", 3, result, what);
  result.rotation = instance_attribute(model, attributes, "ROTATION", 4, result, what);
  result.scale = instance_attribute(model, attributes, "SCALE", 3, result, what);
  return result;
}

template <typename Vector>
std::vector<double> numbers(const Vector& vector) {
  std::vector<double> result;
  for (int c = 0; c < Vector::length(); ++c) result.push_back(vector[c]);
  return result;
}

void expand_instances(tinygltf::Model& model) {
  const std::size_t nodes = model.nodes.size();
  std::size_t instances_left = max_instances;
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto found = model.nodes[i].extensions.find(instancing);
    if (found == model.nodes[i].extensions.end() || model.nodes[i].mesh < 0) continue;
    const std::string name = node_name(model, static_cast<int>(i));
    const Instances instances =
        instances_of(model, found->second, "node \"" + name + "\": " + std::string(instancing));
    if (instances.count > instances_left)
      throw SceneError("node \"" + name + "\": the scene has more than 100000 instances; leave some out");
    instances_left -= instances.count;
    tinygltf::Node child;
    child.name = name;
    child.mesh = model.nodes[i].mesh;
    child.weights = model.nodes[i].weights;
    for (std::size_t k = 0; k < instances.count; ++k) {
      if (instances.translation) child.translation = numbers(instances.translation->vec3(k));
      if (instances.rotation) child.rotation = numbers(instances.rotation->vec4(k));
      if (instances.scale) child.scale = numbers(instances.scale->vec3(k));
      model.nodes[i].children.push_back(static_cast<int>(model.nodes.size()));
      model.nodes.push_back(child);
    }
    if (instances.count > 0) model.nodes[i].mesh = -1;
    model.nodes[i].extensions.erase(instancing);
  }
}

// Of nodes that no scene shows, too: they are carried into a file that is written anew.
void check_meshes(const tinygltf::Model& model) {
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    if (const int mesh = model.nodes[i].mesh;
        mesh != -1 && (mesh < 0 || static_cast<std::size_t>(mesh) >= model.meshes.size()))
      throw SceneError("node \"" + node_name(model, static_cast<int>(i)) + "\": there is no mesh " +
                       std::to_string(mesh));
}

}  // namespace

void make_plain(tinygltf::Model& model) {
  check_meshes(model);
  show_indices(model);
  add_scene(model);
  expand_instances(model);
}

}  // namespace lichtveld::scene
