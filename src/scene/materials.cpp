// Materials, and the textures that their base colours ask for.
#include <cmath>

#include "parts.hpp"

namespace lichtveld::scene {
namespace {

constexpr const char* strength_extension = "KHR_materials_emissive_strength";
constexpr const char* transmission_extension = "KHR_materials_transmission";
constexpr const char* gloss_extension = "KHR_materials_pbrSpecularGlossiness";

glm::vec3 colour(const std::vector<double>& rgb, double scale, double most, const std::string& what) {
  if (rgb.size() < 3) throw SceneError(what + " has no three numbers");
  glm::dvec3 value(1);
  for (int c = 0; c < 3; ++c) {
    value[c] = rgb[static_cast<std::size_t>(c)] * scale;
    if (!(value[c] >= 0 && value[c] <= most))
      throw SceneError(what + " is outside 0.." + (most > 1 ? "1e6" : "1"));
  }
  return value;
}

double emissive_strength(const tinygltf::Material& material, const std::string& what) {
  const auto found = material.extensions.find(strength_extension);
  if (found == material.extensions.end()) return 1;
  if (!found->second.IsObject() || !found->second.Has("emissiveStrength")) return 1;
  const tinygltf::Value& strength = found->second.Get("emissiveStrength");
  if (!strength.IsNumber()) throw SceneError(what + ": emissiveStrength is no number");
  return strength.GetNumberAsDouble();
}

// A texture of an extension, which tinygltf leaves as it is.
tinygltf::TextureInfo texture_info(const tinygltf::Value& value, const std::string& what) {
  tinygltf::TextureInfo info;
  if (!value.IsObject() || !value.Get("index").IsInt()) throw SceneError(what + " has no index");
  info.index = value.Get("index").GetNumberAsInt();
  if (value.Get("texCoord").IsInt()) info.texCoord = value.Get("texCoord").GetNumberAsInt();
  if (value.Get("extensions").IsObject())
    info.extensions = value.Get("extensions").Get<tinygltf::Value::Object>();
  return info;
}

// What a material reflects, as the file has it.
struct Diffuse {
  std::vector<double> factor;
  tinygltf::TextureInfo texture;  // with an index of -1 for none
  std::string factor_name;
};

Diffuse diffuse_of(const tinygltf::Material& material, const std::string& what) {
  const auto found = material.extensions.find(gloss_extension);
  if (found == material.extensions.end() || !found->second.IsObject()) {
    const auto& pbr = material.pbrMetallicRoughness;
    return {pbr.baseColorFactor, pbr.baseColorTexture, "baseColorFactor"};
  }
  Diffuse result{{1, 1, 1, 1}, {}, "diffuseFactor"};
  const std::string name = what + ": " + gloss_extension;
  if (const tinygltf::Value& factor = found->second.Get("diffuseFactor"); factor.IsArray()) {
    if (factor.ArrayLen() != 4) throw SceneError(name + ": diffuseFactor has no four numbers");
    for (std::size_t c = 0; c < 4; ++c) {
      const tinygltf::Value& number = factor.Get(static_cast<int>(c));
      if (!number.IsNumber()) throw SceneError(name + ": diffuseFactor has no four numbers");
      result.factor[c] = number.GetNumberAsDouble();
    }
  }
  if (found->second.Has("diffuseTexture"))
    result.texture = texture_info(found->second.Get("diffuseTexture"), name + ": diffuseTexture");
  return result;
}

float transmission_of(const tinygltf::Material& material, const std::string& what) {
  const auto found = material.extensions.find(transmission_extension);
  if (found == material.extensions.end() || !found->second.IsObject()) return 0;
  const tinygltf::Value& factor = found->second.Get("transmissionFactor");
  if (!found->second.Has("transmissionFactor")) return 0;
  const double value = factor.IsNumber() ? factor.GetNumberAsDouble() : -1;
  if (!(value >= 0 && value <= 1)) throw SceneError(what + ": transmissionFactor is no number of 0..1");
  return static_cast<float>(value);
}

Uneven uneven_of(const tinygltf::Material& in, const glm::vec3& emission, const Diffuse& diffuse,
                 TextureReader& reader, const tinygltf::Model& model, const std::string& what) {
  Uneven result;
  if (in.alphaMode == "MASK") result.alpha = Uneven::Alpha::mask;
  if (in.alphaMode == "BLEND") result.alpha = Uneven::Alpha::blend;
  result.cutoff = static_cast<float>(in.alphaCutoff);
  result.alpha_factor = static_cast<float>(diffuse.factor.size() > 3 ? diffuse.factor[3] : 1);
  if (!std::isfinite(result.cutoff) || !std::isfinite(result.alpha_factor))
    throw SceneError(what + ": alphaCutoff or the base colour's alpha is not finite");
  result.transmission = transmission_of(in, what);
  if (in.emissiveTexture.index == -1 || emission == glm::vec3(0)) return result;
  const std::string texture = what + ": emissiveTexture";
  result.emission = reader.read(in.emissiveTexture, texture);
  result.wrap = wrap_of(model, in.emissiveTexture, texture);
  result.emission_at = coordinates_of(in.emissiveTexture, texture);
  return result;
}

}  // namespace

Materials read_materials(const tinygltf::Model& model) {
  Materials result;
  TextureReader reader(model);
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const tinygltf::Material& in = model.materials[i];
    Material out;
    out.name = in.name.empty() ? "material " + std::to_string(i) : in.name;
    const std::string what = "material \"" + out.name + "\"";
    const Diffuse diffuse = diffuse_of(in, what);
    out.base_colour = colour(diffuse.factor, 1, 1, what + ": " + diffuse.factor_name);
    out.emission = colour(in.emissiveFactor, emissive_strength(in, what), 1e6,
                          what + ": emissiveFactor * " + strength_extension);
    out.double_sided = in.doubleSided;
    TextureCoordinates coordinates;
    if (diffuse.texture.index != -1) {
      out.texture = reader.read(diffuse.texture, what);
      out.wrap = wrap_of(model, diffuse.texture, what);
      coordinates = coordinates_of(diffuse.texture, what);
    }
    result.uneven.push_back(uneven_of(in, out.emission, diffuse, reader, model, what));
    result.materials.push_back(std::move(out));
    result.colour.push_back(coordinates);
  }
  Material standard;
  standard.name = "default";
  result.materials.push_back(standard);
  result.colour.emplace_back();
  result.uneven.emplace_back();
  result.textures = std::move(reader.textures());
  return result;
}

}  // namespace lichtveld::scene
