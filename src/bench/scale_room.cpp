#include "scale_room.hpp"

#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

namespace lichtveld::bench {

namespace {

using nlohmann::json;

// glTF's numbers for component types.
constexpr int floats = 5126, words = 5125;

struct Chart {
  float u, v, width, height;  // of TEXCOORD_1
};

class Room {
 public:
  int material(const glm::vec3& colour, float emission = 0) {
    json material = {{"pbrMetallicRoughness", {{"baseColorFactor", {colour.r, colour.g, colour.b, 1}}}}};
    if (emission > 0) {
      material["emissiveFactor"] = {1, 1, 1};
      material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = emission;
    }
    return push("materials", material);
  }

  // A grid of cells over the unit square, which `place` puts into the room and a chart shows.
  using Place = std::function<glm::vec3(glm::vec2)>;
  void grid(std::uint32_t columns, std::uint32_t rows, const Chart& chart, const Place& place) {
    const auto first = static_cast<std::uint32_t>(positions_.size());
    for (std::uint32_t j = 0; j <= rows; ++j)
      for (std::uint32_t i = 0; i <= columns; ++i) {
        const glm::vec2 at = glm::vec2(i, j) / glm::vec2(columns, rows);
        positions_.push_back(place(at));
        atlas_.push_back(glm::vec2(chart.u, chart.v) + at * glm::vec2(chart.width, chart.height));
      }
    for (std::uint32_t j = 0; j < rows; ++j)
      for (std::uint32_t i = 0; i < columns; ++i) {
        const std::uint32_t a = first + j * (columns + 1) + i, b = a + 1, c = b + columns + 1, d = c - 1;
        indices_.insert(indices_.end(), {a, b, c, a, c, d});
      }
  }

  // The six faces of a box, looking out of it, or in.
  void box(const glm::vec3& low, const glm::vec3& high, const Chart& chart, bool inwards) {
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
      const bool far = face % 2 == 1;
      const float width = chart.width / 3, height = chart.height / 2, gap = 0.1f;
      const Chart own{chart.u + width * (static_cast<float>(face % 3) + gap),
                      chart.v + height * (static_cast<float>(face / 3) + gap), width * (1 - 2 * gap),
                      height * (1 - 2 * gap)};
      grid(1, 1, own, [&](glm::vec2 at) {
        if (far == inwards) std::swap(at.x, at.y);
        glm::vec3 place;
        place[axis] = far ? high[axis] : low[axis];
        place[u] = glm::mix(low[u], high[u], at.x);
        place[v] = glm::mix(low[v], high[v], at.y);
        return place;
      });
    }
  }

  // What has been put there since the last one is this.
  void node(const std::string& name, int material, bool movable = false) {
    const json attributes = {{"POSITION", accessor(positions_, floats, "VEC3")},
                             {"TEXCOORD_1", accessor(atlas_, floats, "VEC2")}};
    const json primitive = {
        {"attributes", attributes}, {"indices", accessor(indices_, words, "SCALAR")}, {"material", material}};
    const int mesh = push("meshes", {{"primitives", {primitive}}});
    const int node = push("nodes", {{"name", name}, {"mesh", mesh}});
    if (movable) gltf_["nodes"][static_cast<std::size_t>(node)]["extras"]["movable"] = true;
    gltf_["scenes"][0]["nodes"].push_back(node);
    positions_.clear();
    atlas_.clear();
    indices_.clear();
  }

  std::string glb() const {
    json document = gltf_;
    document["buffers"] = {{{"byteLength", binary_.size()}}};
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return "glTF" + word(2) + word(28 + text.size() + binary_.size()) + word(text.size()) + "JSON" + text +
           word(binary_.size()) + std::string("BIN\0", 4) + binary_;
  }

 private:
  static std::string word(std::size_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(value >> (8 * i)));
    return bytes;
  }

  int push(const char* key, const json& entry) {
    gltf_[key].push_back(entry);
    return static_cast<int>(gltf_[key].size()) - 1;
  }

  // Everything is of 4 bytes, and so aligned.
  template <typename Element>
  int accessor(const std::vector<Element>& elements, int component, const char* type) {
    const std::size_t bytes = elements.size() * sizeof(Element);
    const int view =
        push("bufferViews", {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}});
    binary_.append(reinterpret_cast<const char*>(elements.data()), bytes);
    return push(
        "accessors",
        {{"bufferView", view}, {"componentType", component}, {"count", elements.size()}, {"type", type}});
  }

  json gltf_ = {{"asset", {{"version", "2.0"}}},
                {"extensionsUsed", {"KHR_materials_emissive_strength"}},
                {"scene", 0},
                {"scenes", {{{"nodes", json::array()}}}}};
  std::string binary_;
  std::vector<glm::vec3> positions_;
  std::vector<glm::vec2> atlas_;
  std::vector<std::uint32_t> indices_;
};

}  // namespace

std::string scale_room(std::uint32_t triangles, float lamp) {
  constexpr float pi = std::numbers::pi_v<float>;
  Room room;
  const int grey = room.material(glm::vec3(0.6f));
  room.box({-2, -0.2f, -2}, {2, 3, 2}, {0.5f, 0, 0.5f, 0.5f}, true);
  room.node("walls", grey);
  const auto side = static_cast<std::uint32_t>(std::max(std::lround(std::sqrt(triangles / 2.0)), 1L));
  room.grid(side, side, {0.01f, 0.01f, 0.48f, 0.48f}, [](const glm::vec2& at) {
    const float height = 0.05f * (std::sin(9 * pi * at.x) * std::sin(7 * pi * at.y));
    return glm::vec3(-2 + 4 * at.y, height, -2 + 4 * at.x);
  });
  room.node("floor", room.material({0.7f, 0.6f, 0.5f}));
  const float wide = 3.9f * lamp;
  room.grid(1, 1, {0.51f, 0.76f, 0.05f, 0.05f},
            [&](const glm::vec2& at) { return glm::vec3(wide * (at.x - 0.5f), 2.9f, wide * (at.y - 0.5f)); });
  room.node("lamp", room.material(glm::vec3(0.5f), 4 / (wide * wide)));
  room.box({-0.8f, 0.3f, -0.6f}, {-0.3f, 0.8f, -0.1f}, {0.51f, 0.51f, 0.24f, 0.24f}, false);
  room.node("cube", grey, true);
  room.grid(50, 50, {0.01f, 0.51f, 0.2f, 0.1f}, [](const glm::vec2& at) {
    const float round = 2 * pi * at.x, up = pi * glm::mix(0.002f, 0.998f, at.y);  // no triangle without area
    return glm::vec3(0.8f, 0.6f, 0.4f) +
           0.25f * glm::vec3(std::sin(up) * std::cos(round), -std::cos(up), -std::sin(up) * std::sin(round));
  });
  room.node("ball", grey, true);
  return room.glb();
}

}  // namespace lichtveld::bench
