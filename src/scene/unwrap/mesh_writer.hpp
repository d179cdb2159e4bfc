#pragma once

#include <tiny_gltf.h>

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "atlas_packing.hpp"
#include "plain_file.hpp"
#include "sheets.hpp"

namespace lichtveld::scene {

// The number of a material as one that has a front alone.
class OneSided {
 public:
  explicit OneSided(nlohmann::json& root) : root_(root) {}
  int of(int material) {
    if (const auto known = twins_.find(material); known != twins_.end()) return known->second;
    nlohmann::json twin = root_["materials"].at(static_cast<std::size_t>(material));
    twin["doubleSided"] = false;
    root_["materials"].push_back(std::move(twin));
    return twins_[material] = static_cast<int>(root_["materials"].size()) - 1;
  }

 private:
  nlohmann::json& root_;
  std::map<int, int> twins_;
};

struct Split;

// Writes a file with a mesh for each node, whose TEXCOORD_1 are its charts' places in an atlas.
class MeshWriter {
 public:
  // Of a file's JSON and its model, which must outlive it.
  MeshWriter(Document document, const tinygltf::Model& model);

  // A mesh for each of its uses, whose spots are the next of `spot`.
  void add(int number, const UsedMesh& mesh, const Atlas& atlas, std::size_t& spot);

  void name_light_map(const std::string& uri) { file_.name_light_map(uri); }

  std::vector<std::uint8_t> finish() { return file_.finish(); }

 private:
  nlohmann::json primitive_of(int mesh, const Sheet& sheet, const Split& split);
  int normals_of(int accessor, const Split& split);

  const tinygltf::Model& model_;
  std::optional<int> moved_set_;
  PlainFile file_;
  OneSided one_sided_;
};

}  // namespace lichtveld::scene
