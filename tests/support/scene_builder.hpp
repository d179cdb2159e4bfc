// Small glTF scenes in memory, for tests: quads and boxes with a chart each, materials, movable nodes. `gltf`
// and `bin` stay open, so that a test can spoil what it wants.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lichtveld::testing {

struct Chart {
  float u0, v0, u1, v1;  // TEXCOORD_1: left, top, right, bottom
};

class SceneBuilder {
 public:
  nlohmann::json gltf = {
      {"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", nlohmann::json::array()}}}}};
  std::string bin;

  // Emission in W m^-2 sr^-1, stored as emissiveFactor 0..1 times KHR_materials_emissive_strength.
  int material(glm::vec3 colour, glm::vec3 emission = glm::vec3(0), bool double_sided = false) {
    nlohmann::json m = {{"pbrMetallicRoughness", {{"baseColorFactor", {colour.r, colour.g, colour.b, 1}}}},
                        {"doubleSided", double_sided}};
    if (const float strength = std::max({emission.r, emission.g, emission.b}); strength > 0) {
      const glm::vec3 factor = emission / strength;
      m["emissiveFactor"] = {factor.r, factor.g, factor.b};
      m["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
    }
    return push("materials", m);
  }

  template <typename T>
  int accessor(const std::vector<T>& elements, int component_type, const char* type) {
    while (bin.size() % 4) bin.push_back('\0');
    const std::size_t bytes = elements.size() * sizeof(T);
    const int view = push("bufferViews", {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes}});
    bin.append(reinterpret_cast<const char*>(elements.data()), bytes);
    return push(
        "accessors",
        {{"bufferView", view}, {"componentType", component_type}, {"count", elements.size()}, {"type", type}});
  }

  // A node with a mesh of one primitive without NORMAL; `indices` may be empty.
  int mesh(const std::string& name, const std::vector<glm::vec3>& positions,
           const std::vector<glm::vec2>& atlas, const std::vector<std::uint16_t>& indices, int material) {
    nlohmann::json primitive = {
        {"attributes",
         {{"POSITION", accessor(positions, 5126, "VEC3")}, {"TEXCOORD_1", accessor(atlas, 5126, "VEC2")}}},
        {"material", material}};
    if (!indices.empty()) primitive["indices"] = accessor(indices, 5123, "SCALAR");
    const int mesh = push("meshes", {{"primitives", {primitive}}});
    const int node = push("nodes", {{"name", name}, {"mesh", mesh}});
    gltf["scenes"][0]["nodes"].push_back(node);
    return node;
  }

  // Corners counter-clockwise seen from the front; the first lies at the chart's bottom left.
  int quad(const std::string& name, const std::array<glm::vec3, 4>& p, Chart c, int material) {
    return mesh(name, {p.begin(), p.end()}, corners(c), {0, 1, 2, 0, 2, 3}, material);
  }

  // Faces outwards, or inwards as a room does. Its six faces share the chart as 3 x 2 cells with gutters of 1/8
  // cell on every side.
  int box(const std::string& name, glm::vec3 low, glm::vec3 high, Chart c, int material, bool inwards = false) {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> atlas;
    std::vector<std::uint16_t> indices;
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
      const bool far = face % 2;
      const glm::vec2 cell{(c.u1 - c.u0) / 3, (c.v1 - c.v0) / 2};
      const glm::vec2 at = glm::vec2(c.u0, c.v0) + cell * glm::vec2(face % 3, face / 3);
      for (const glm::vec2& uv :
           corners({at.x + cell.x / 8, at.y + cell.y / 8, at.x + cell.x * 7 / 8, at.y + cell.y * 7 / 8}))
        atlas.push_back(uv);
      for (const glm::ivec2 corner : {glm::ivec2(0, 0), glm::ivec2(1, 0), glm::ivec2(1, 1), glm::ivec2(0, 1)}) {
        glm::vec3 p;
        p[axis] = far ? high[axis] : low[axis];
        p[u] = corner.x ? high[u] : low[u];
        p[v] = corner.y ? high[v] : low[v];
        positions.push_back(p);
      }
      for (int k : far != inwards ? std::array{0, 1, 2, 0, 2, 3} : std::array{0, 2, 1, 0, 3, 2}) {
        indices.push_back(static_cast<std::uint16_t>(4 * face + k));
      }
    }
    return mesh(name, positions, atlas, indices, material);
  }

  nlohmann::json& node(int index) { return gltf["nodes"][static_cast<std::size_t>(index)]; }
  nlohmann::json& primitive(int node_index) {
    return gltf["meshes"][node(node_index)["mesh"].get<std::size_t>()]["primitives"][0];
  }
  void set_movable(int index) { node(index)["extras"]["movable"] = true; }

  std::string glb() const {
    nlohmann::json document = gltf;
    std::string chunk = bin;
    chunk.resize((chunk.size() + 3) / 4 * 4);
    if (!document.contains("buffers")) document["buffers"] = {{{"byteLength", chunk.size()}}};
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return "glTF" + word(2) + word(28 + text.size() + chunk.size()) + word(text.size()) + "JSON" + text +
           word(chunk.size()) + std::string("BIN\0", 4) + chunk;
  }

 private:
  static std::vector<glm::vec2> corners(Chart c) {
    return {{c.u0, c.v1}, {c.u1, c.v1}, {c.u1, c.v0}, {c.u0, c.v0}};
  }

  static std::string word(std::size_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(value >> (8 * i)));
    return bytes;
  }

  int push(const char* key, const nlohmann::json& entry) {
    gltf[key].push_back(entry);
    return static_cast<int>(gltf[key].size()) - 1;
  }
};

// A folder of one test, gone with it.
class TempFolder {
 public:
  TempFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "lichtveld-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder at " + name);
    path_ = name;
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace lichtveld::testing
