#include "mesh_writer.hpp"

#include <algorithm>
#include <functional>
#include <string>

#include "accessor.hpp"

namespace lichtveld::scene {

using nlohmann::json;

// The vertices of a sheet once its charts have come apart.
struct Split {
  std::vector<std::uint32_t> elements;                     // of the file's accessors, one a vertex
  std::vector<bool> back;                                  // of each vertex
  std::vector<std::pair<std::uint32_t, glm::dvec2>> flat;  // of each vertex: its chart, and where in it
  std::vector<std::uint32_t> indices;
};

namespace {

// What textures use TEXCOORD_1 for moves to a set that nobody has; its number, or nothing.
std::optional<int> move_texture_set(json& root) {
  bool used = false;
  int set = 0;
  const std::function<void(json&, bool)> walk = [&](json& value, bool change) {
    if (value.is_object() && value.contains("texCoord") && value["texCoord"] == 1) {
      used = true;
      if (change) value["texCoord"] = set;
    }
    if (value.is_structured())
      for (auto& inner : value) walk(inner, change);
  };
  if (!root.contains("materials")) return std::nullopt;
  walk(root["materials"], false);
  if (!used) return std::nullopt;
  for (const auto& mesh : root["meshes"])
    for (const auto& primitive : mesh["primitives"])
      while (primitive["attributes"].contains("TEXCOORD_" + std::to_string(std::max(set, 2)))) ++set;
  set = std::max(set, 2);
  walk(root["materials"], true);
  return set;
}

Split split_of(const Sheet& sheet) {
  constexpr std::uint32_t none = ~0u;
  struct Key {
    std::uint32_t element, chart;
    double x, y;
    bool back;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<std::pair<std::uint32_t, std::array<glm::dvec2, 3>>> flat(sheet.triangles.size(), {none, {}});
  for (std::uint32_t c = 0; c < sheet.charts.size(); ++c)
    for (std::size_t i = 0; i < sheet.charts[c].triangles.size(); ++i)
      flat[sheet.charts[c].triangles[i]] = {c, sheet.charts[c].flat[i]};
  std::map<Key, std::uint32_t> known;
  Split split;
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [chart, corners] = flat[t];
      const bool back = t >= sheet.fronts;
      const Key key{sheet.triangles[t][k], chart, corners[k].x, corners[k].y, back};
      const auto [found, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(split.elements.size()));
      split.indices.push_back(found->second);
      if (!is_new) continue;
      split.elements.push_back(key.element);
      split.back.push_back(back);
      split.flat.emplace_back(chart, corners[k]);
    }
  return split;
}

void fill_set(json& attributes, int set) {
  const std::string name = "TEXCOORD_" + std::to_string(set);
  if (!attributes.contains(name)) attributes[name] = attributes["TEXCOORD_1"];
}

}  // namespace

MeshWriter::MeshWriter(Document document, const tinygltf::Model& model)
    : model_(model),
      moved_set_(move_texture_set(document.root)),
      file_(std::move(document), model),
      one_sided_(file_.root()) {}

void MeshWriter::add(int number, const UsedMesh& mesh, const Atlas& atlas, std::size_t& spot) {
  std::vector<Split> splits;
  std::vector<json> primitives;
  for (const auto& sheet : mesh.sheets) {
    splits.push_back(split_of(sheet));
    primitives.push_back(primitive_of(number, sheet, splits.back()));
  }
  for (const auto& use : mesh.uses) {
    json out = file_.root()["meshes"][static_cast<std::size_t>(number)];
    out["primitives"] = json::array();
    for (std::size_t s = 0; s < mesh.sheets.size(); ++s) {
      const auto& sheet = mesh.sheets[s];
      std::vector<float> numbers;
      for (const auto& [chart, place] : splits[s].flat) {
        glm::vec2 at(0);
        if (chart < sheet.charts.size())
          at = in_atlas(sheet.charts[chart], atlas.rectangles[spot + chart], place, atlas.size);
        numbers.push_back(at.x);
        numbers.push_back(at.y);
      }
      spot += sheet.charts.size();
      json primitive = primitives[s];
      auto& attributes = primitive["attributes"];
      attributes["TEXCOORD_1"] = file_.add_vec2(numbers);
      // Sets are counted from 0 without gaps.
      for (int set = 0; moved_set_ && set < *moved_set_; ++set) fill_set(attributes, set);
      fill_set(attributes, 0);
      out["primitives"].push_back(std::move(primitive));
    }
    file_.show(static_cast<std::size_t>(use.node), file_.add_mesh(std::move(out)));
  }
}

json MeshWriter::primitive_of(int mesh, const Sheet& sheet, const Split& split) {
  const auto& in = model_.meshes[static_cast<std::size_t>(mesh)].primitives[sheet.primitive];
  json out = without_compression(
      file_.root()["meshes"][static_cast<std::size_t>(mesh)]["primitives"][sheet.primitive]);
  const auto vertices = [&](const std::string& semantic, int accessor) {
    return semantic == "NORMAL" ? normals_of(accessor, split)
                                : file_.chosen(accessor, split.elements, semantic);
  };
  out["mode"] = TINYGLTF_MODE_TRIANGLES;
  out["attributes"] = json::object();
  for (const auto& [semantic, accessor] : in.attributes) {
    if (semantic == "TEXCOORD_1" && !moved_set_) continue;
    const std::string name = semantic == "TEXCOORD_1" ? "TEXCOORD_" + std::to_string(*moved_set_) : semantic;
    out["attributes"][name] = vertices(semantic, accessor);
  }
  for (std::size_t t = 0; t < in.targets.size(); ++t)
    for (const auto& [semantic, accessor] : in.targets[t])
      out["targets"][t][semantic] = vertices(semantic, accessor);
  out["indices"] = file_.add_indices(split.indices);
  if (sheet.double_sided) out["material"] = one_sided_.of(in.material);
  return out;
}

// Those of backs point the other way.
int MeshWriter::normals_of(int accessor, const Split& split) {
  if (std::ranges::none_of(split.back, std::identity{}))
    return file_.chosen(accessor, split.elements, "NORMAL");
  const Accessor normals(model_, accessor, "NORMAL");
  normals.require_vectors(3);
  std::vector<float> numbers;
  for (std::size_t i = 0; i < split.elements.size(); ++i) {
    if (split.elements[i] >= normals.count()) throw SceneError("NORMAL has fewer elements than POSITION");
    const glm::vec3 normal = normals.vec3(split.elements[i]) * (split.back[i] ? -1.0f : 1.0f);
    numbers.insert(numbers.end(), {normal.x, normal.y, normal.z});
  }
  return file_.add_vec3(numbers);
}

}  // namespace lichtveld::scene
