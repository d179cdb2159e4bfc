// The node tree, flattened.
#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "model.hpp"
#include "parts.hpp"

namespace lichtveld::scene {
namespace {

void require(const std::vector<double>& values, std::size_t size, const std::string& what) {
  if (values.size() != size) throw SceneError(what + " has " + std::to_string(values.size()) + " numbers");
  for (double value : values) {
    if (!std::isfinite(value)) throw SceneError(what + " holds a number that is not finite");
  }
}

glm::dmat4 local_transform(const tinygltf::Node& node, const std::string& what) {
  glm::dmat4 result(1);
  if (!node.matrix.empty()) {
    require(node.matrix, 16, what + ": matrix");
    for (int i = 0; i < 16; ++i) result[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    return result;
  }
  if (const auto& t = node.translation; !t.empty()) {
    require(t, 3, what + ": translation");
    result = glm::translate(result, glm::dvec3(t[0], t[1], t[2]));
  }
  if (const auto& r = node.rotation; !r.empty()) {
    require(r, 4, what + ": rotation");
    const glm::dquat rotation(r[3], r[0], r[1], r[2]);
    if (!(glm::length(rotation) > 1e-6)) throw SceneError(what + ": rotation is no unit quaternion");
    result *= glm::mat4_cast(glm::normalize(rotation));
  }
  if (const auto& s = node.scale; !s.empty()) {
    require(s, 3, what + ": scale");
    result = glm::scale(result, glm::dvec3(s[0], s[1], s[2]));
  }
  return result;
}

bool is_hidden(const tinygltf::Node& node) {
  const auto found = node.extensions.find("KHR_node_visibility");
  if (found == node.extensions.end() || !found->second.IsObject()) return false;
  const tinygltf::Value& visible = found->second.Get("visible");
  return visible.IsBool() && !visible.Get<bool>();
}

}  // namespace

bool says(const tinygltf::Value& extras, const char* name) {
  if (!extras.IsObject() || !extras.Has(name)) return false;
  const tinygltf::Value& value = extras.Get(name);
  return value.IsBool() && value.Get<bool>();
}

bool are_of_light(const tinygltf::Value& extras) {
  return says(extras, "switchable") || (extras.IsObject() && (extras.Has("flicker") || extras.Has("schedule")));
}

Light light_of(const tinygltf::Value& extras, const std::string& node, const std::string& what) {
  const auto number = [&](const char* name, double most) {
    if (!extras.IsObject() || !extras.Has(name)) return 0.0f;
    const auto& value = extras.Get(name);
    const double found = value.IsNumber() ? value.GetNumberAsDouble() : -1;
    if (!(found >= 0 && found <= most))
      throw SceneError(what + ": extras." + name + " is no number of 0.." + std::to_string(std::lround(most)));
    return static_cast<float>(found);
  };
  constexpr double longest_day = 24 * 60;
  return {.node = node,
          .switchable = says(extras, "switchable"),
          .flicker = number("flicker", 1),
          .day = number("schedule", longest_day)};
}

int scene_of(const tinygltf::Model& model) {
  const int chosen = model.defaultScene < 0 ? 0 : model.defaultScene;
  if (static_cast<std::size_t>(chosen) >= model.scenes.size()) {
    throw SceneError("there is no scene " + std::to_string(chosen) + ": export with a scene");
  }
  return chosen;
}

std::vector<PlacedNode> place_nodes(const tinygltf::Model& model, std::span<const std::string> lights) {
  const int chosen = scene_of(model);
  std::vector<PlacedNode> result;
  std::vector<bool> reached(model.nodes.size());
  // Visits a node under its parent. A node that is reached twice has two parents or is its own ancestor, and
  // walking on would take exponential time or never end.
  std::vector<PlacedNode> open;
  const auto enter = [&](int node, const PlacedNode& parent, const std::string& from) {
    if (node < 0 || static_cast<std::size_t>(node) >= model.nodes.size()) {
      throw SceneError(from + ": there is no node " + std::to_string(node));
    }
    if (reached[static_cast<std::size_t>(node)]) {
      throw SceneError("node \"" + node_name(model, node) +
                       "\" is reached twice: the nodes form a cycle, or a node has "
                       "two parents");
    }
    reached[static_cast<std::size_t>(node)] = true;
    const tinygltf::Node& in = model.nodes[static_cast<std::size_t>(node)];
    const std::string name = node_name(model, node);
    const bool is_light = are_of_light(in.extras) || std::ranges::find(lights, name) != lights.end();
    open.push_back({.node = node,
                    .world = parent.world * local_transform(in, "node \"" + name + "\""),
                    .visible = parent.visible && !is_hidden(in),
                    .movable = parent.movable < 0 && says(in.extras, "movable") ? node : parent.movable,
                    .light = parent.light < 0 && is_light ? node : parent.light});
  };
  for (int node : model.scenes[static_cast<std::size_t>(chosen)].nodes) {
    enter(node, {}, "scene " + std::to_string(chosen));
  }
  while (!open.empty()) {
    const PlacedNode placed = open.back();
    open.pop_back();
    result.push_back(placed);
    for (int child : model.nodes[static_cast<std::size_t>(placed.node)].children) {
      enter(child, placed, "node \"" + node_name(model, placed.node) + "\"");
    }
  }
  std::ranges::sort(result, {}, &PlacedNode::node);
  return result;
}

}  // namespace lichtveld::scene
