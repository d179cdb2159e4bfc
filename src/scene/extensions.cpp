#include "extensions.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>

#include "lichtveld/scene/scene.hpp"

namespace lichtveld::scene {
namespace {

using nlohmann::json;

// Those that are read, and formats of textures, of which their readers tell.
constexpr std::array<std::string_view, 16> read_here = {
    "EXT_lights_image_based",     "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",    "KHR_meshopt_compression",
    "KHR_draco_mesh_compression", "EXT_texture_webp",
    "KHR_lights_punctual",        "KHR_materials_emissive_strength",
    "KHR_materials_transmission", "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",        "KHR_mesh_quantization",
    "KHR_node_visibility",        "KHR_texture_basisu",
    "KHR_texture_transform",      "EXT_texture_avif"};

// Of these diffuse light knows nothing: gloss, animation, physics, sound, data about the file.
constexpr std::array<std::string_view, 30> without_effect = {"ADOBE_",
                                                             "AGI_",
                                                             "CESIUM_",
                                                             "EXT_instance_features",
                                                             "EXT_mesh_features",
                                                             "EXT_mesh_manifold",
                                                             "EXT_mesh_polygon",
                                                             "EXT_structural_metadata",
                                                             "FB_",
                                                             "GODOT_",
                                                             "GOOGLE_",
                                                             "KHR_animation_pointer",
                                                             "KHR_audio",
                                                             "KHR_collision_shapes",
                                                             "KHR_implicit_shapes",
                                                             "KHR_interactivity",
                                                             "KHR_materials_anisotropy",
                                                             "KHR_materials_clearcoat",
                                                             "KHR_materials_dispersion",
                                                             "KHR_materials_ior",
                                                             "KHR_materials_iridescence",
                                                             "KHR_materials_sheen",
                                                             "KHR_materials_specular",
                                                             "KHR_materials_variants",
                                                             "KHR_physics_",
                                                             "KHR_xmp",
                                                             "MSFT_",
                                                             "NV_",
                                                             "OMI_",
                                                             "VRM"};

bool is_known(const std::string& name) {
  return std::ranges::find(read_here, name) != read_here.end() ||
         std::ranges::any_of(without_effect, [&](std::string_view start) { return name.starts_with(start); });
}

std::set<std::string> unknown_required(const json& root) {
  std::set<std::string> unknown;
  const auto found = root.find("extensionsRequired");
  if (found == root.end() || !found->is_array()) return unknown;
  for (const json& name : *found) {
    const std::string text = name.is_string() ? name.get<std::string>() : name.dump();
    if (!is_known(text)) unknown.insert(text);
  }
  return unknown;
}

// Which of the extensions an object has, or nothing.
std::string one_of(const json& object, const std::set<std::string>& extensions) {
  const auto found = object.find("extensions");
  if (found == object.end() || !found->is_object()) return {};
  for (const auto& [name, value] : found->items())
    if (extensions.contains(name)) return name;
  return {};
}

// Whether an accessor has bytes of its own.
bool has_bytes(const json& root, const json& primitive, const char* attribute) {
  try {
    const json& accessor = root.at("accessors").at(primitive.at("attributes").at(attribute).get<std::size_t>());
    return accessor.contains("bufferView") || accessor.contains("sparse");
  } catch (const json::exception&) {
    return true;  // damaged in another way, of which others tell
  }
}

[[noreturn]] void refuse(const std::string& what, const std::string& extension) {
  const bool packed = extension.find("compression") != std::string::npos;
  throw SceneError(what + " is there by " + extension + " alone, which is not read; " +
                   (packed ? "undo it with npx @gltf-transform/cli copy in.glb out.glb, or export without "
                             "compression"
                           : "export without it"));
}

void check_geometry(const json& root, const std::set<std::string>& unknown) {
  if (const auto views = root.find("bufferViews"); views != root.end() && views->is_array())
    for (std::size_t i = 0; i < views->size(); ++i)
      if (const auto name = one_of((*views)[i], unknown); !name.empty())
        refuse("buffer view " + std::to_string(i), name);
  const auto meshes = root.find("meshes");
  if (meshes == root.end() || !meshes->is_array()) return;
  for (std::size_t i = 0; i < meshes->size(); ++i) {
    const auto primitives = (*meshes)[i].find("primitives");
    if (primitives == (*meshes)[i].end() || !primitives->is_array()) continue;
    for (std::size_t k = 0; k < primitives->size(); ++k) {
      const json& primitive = (*primitives)[k];
      const auto name = primitive.is_object() ? one_of(primitive, unknown) : std::string();
      if (!name.empty() && !has_bytes(root, primitive, "POSITION"))
        refuse("mesh " + std::to_string(i) + ", primitive " + std::to_string(k), name);
    }
  }
}

}  // namespace

void check_extensions(const json& root, Remarks& remarks) {
  const std::set<std::string> unknown = unknown_required(root);
  if (unknown.empty()) return;
  check_geometry(root, unknown);
  std::string names;
  for (const std::string& name : unknown) names += (names.empty() ? "" : ", ") + name;
  remarks.add("requires " + names + ", unknown here: what they add is left out", {},
              "export it without these extensions if something is missing");
}

}  // namespace lichtveld::scene
