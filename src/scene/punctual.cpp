// KHR_lights_punctual: lights without a surface.
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "model.hpp"
#include "parts.hpp"

namespace lichtveld::scene {
namespace {

constexpr const char* extension = "KHR_lights_punctual";
// Each costs a ray a texel: more is a mistake.
constexpr std::size_t most_lights = 1024;
// As the file has it, maybe in lumens: sums of what comes of it at a millimetre are finite.
constexpr double brightest = 1e12;

using Kind = PunctualLight::Kind;

Kind kind_of(const std::string& type, const std::string& what) {
  if (type == "directional") return Kind::directional;
  if (type == "point") return Kind::point;
  if (type == "spot") return Kind::spot;
  throw SceneError(what + ": there is no light of type \"" + type +
                   "\"; directional, point and spot are known");
}

double require(double value, bool good, const std::string& what, const std::string& range) {
  if (!std::isfinite(value) || !good) throw SceneError(fmt::format("{} is {:g}: {}", what, value, range));
  return value;
}

// Of the file.
glm::vec3 intensity_of(const tinygltf::Light& light, const std::string& what) {
  const double intensity =
      require(light.intensity, light.intensity >= 0, what + ": intensity", "it must be 0 or more");
  glm::vec3 colour(1);
  if (!light.color.empty() && light.color.size() != 3)
    throw SceneError(what + ": color has " + std::to_string(light.color.size()) + " numbers");
  for (std::size_t channel = 0; channel < light.color.size(); ++channel)
    colour[static_cast<int>(channel)] = static_cast<float>(
        require(light.color[channel], light.color[channel] >= 0, what + ": color", "it must be 0 or more"));
  for (int channel = 0; channel < 3; ++channel)
    require(intensity * double{colour[channel]}, intensity * double{colour[channel]} <= brightest,
            what + ": intensity times color", "it must be at most 1e12");
  return colour * static_cast<float>(intensity);
}

// A number of the light's extras, or `otherwise`.
double extra(const tinygltf::Light& light, const char* name, double otherwise, double most,
             const std::string& what) {
  if (!light.extras.IsObject() || !light.extras.Has(name)) return otherwise;
  const auto& value = light.extras.Get(name);
  if (!value.IsNumber()) throw SceneError(what + ": extras." + name + " is no number");
  const double number = value.GetNumberAsDouble();
  return require(number, number >= 0 && number <= most, what + ": extras." + name,
                 fmt::format("it must be 0..{:g}", most));
}

void set_cone(const tinygltf::Light& light, const std::string& what, PunctualLight& result) {
  const double inner = light.spot.innerConeAngle, outer = light.spot.outerConeAngle;
  require(outer, outer > 0 && outer <= std::numbers::pi / 2, what + ": outerConeAngle",
          "it must be above 0 and at most pi/2");
  require(inner, inner >= 0 && inner < outer, what + ": innerConeAngle",
          "it must be 0 or more and below outerConeAngle");
  result.inner_cosine = static_cast<float>(std::cos(inner));
  result.outer_cosine = static_cast<float>(std::cos(outer));
}

}  // namespace

std::vector<PunctualLight> read_lights(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes,
                                       const Owners& owners, double lumens_per_watt) {
  std::vector<PunctualLight> lights;
  for (const PlacedNode& placed : nodes) {
    const auto& node = model.nodes[static_cast<std::size_t>(placed.node)];
    const auto found = node.extensions.find(extension);
    if (found == node.extensions.end() || !placed.visible) continue;
    const std::string name = node_name(model, placed.node), what = "node \"" + name + "\": light";
    const int number =
        found->second.IsObject() && found->second.Has("light") && found->second.Get("light").IsInt()
            ? found->second.Get("light").GetNumberAsInt()
            : -1;
    if (number < 0 || static_cast<std::size_t>(number) >= model.lights.size())
      throw SceneError(what + ": there is no light " + std::to_string(number));
    if (lights.size() == most_lights)
      throw SceneError("more than " + std::to_string(most_lights) + " lights: each costs a ray a texel");
    const auto& light = model.lights[static_cast<std::size_t>(number)];
    PunctualLight result{.node = name,
                         .kind = kind_of(light.type, what),
                         .intensity = intensity_of(light, what) / static_cast<float>(lumens_per_watt),
                         .place = glm::vec3(placed.world[3]),
                         .body = owners.body.at(placed.movable),
                         .light = owners.light.at(placed.light)};
    const glm::dvec3 along = -glm::dvec3(placed.world[2]);
    if (!(glm::length(along) > 0)) throw SceneError(what + ": its node's scale leaves it no direction");
    result.direction = glm::normalize(along);
    if (light.range != 0)
      result.range =
          static_cast<float>(require(light.range, light.range > 0, what + ": range", "it must be above 0"));
    if (result.kind == Kind::spot) set_cone(light, what, result);
    if (result.kind == Kind::directional)
      result.angle = static_cast<float>(extra(light, "angle", sun_angle, 90, what));
    else
      result.radius = static_cast<float>(extra(light, "radius", 0, 1e6, what));
    lights.push_back(result);
  }
  return lights;
}

}  // namespace lichtveld::scene
