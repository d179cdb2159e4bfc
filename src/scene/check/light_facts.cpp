// Who emits, by name.
#include <algorithm>
#include <map>
#include <numbers>
#include <utility>

#include "facts.hpp"
#include "lichtveld/scene/lights.hpp"
#include "triangle.hpp"

namespace lichtveld::scene {
namespace {

using Kind = LightFacts::Kind;

double brightest(const glm::vec3& colour) {
  return std::max({colour.r, colour.g, colour.b});
}

// As find_lights calls it.
LightFacts named(const Scene& scene, std::uint32_t light, const std::string& own_name, Kind kind) {
  LightFacts facts;
  facts.name = light > 0 ? scene.lights[light].node : own_name;
  facts.kind = kind;
  facts.switchable = light > 0 && scene.lights[light].switchable;
  return facts;
}

// Of a flat surface of even radiance pi Le A goes out, and as much from its back where there is one.
glm::dvec3 flux_of(const Scene& scene, const Surface& surface) {
  const auto& material = scene.materials[surface.material];
  double area = 0;
  for (std::uint32_t i = 0; i < surface.index_count; i += 3) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = scene.vertices[scene.indices[surface.first_index + i + k]].position;
    area += area_of(corners);
  }
  return std::numbers::pi * (material.double_sided ? 2 : 1) * area * glm::dvec3(material.emission);
}

}  // namespace

std::vector<LightFacts> light_facts(const Scene& scene) {
  std::vector<LightFacts> all;
  std::map<std::pair<std::uint32_t, std::string>, glm::dvec3> surfaces;
  for (const auto& surface : scene.surfaces)
    if (scene.materials[surface.material].emission != glm::vec3(0))
      surfaces[{surface.light, surface.light > 0 ? "" : surface.node}] += flux_of(scene, surface);
  for (const auto& [of, flux] : surfaces) {
    all.push_back(named(scene, of.first, of.second, Kind::surface));
    all.back().flux = flux;
  }
  for (const auto& light : scene.punctual) {
    const bool directional = light.kind == PunctualLight::Kind::directional;
    all.push_back(named(scene, light.light, light.node,
                        directional                               ? Kind::directional
                        : light.kind == PunctualLight::Kind::spot ? Kind::spot
                                                                  : Kind::point));
    (directional ? all.back().irradiance : all.back().flux) = directional ? light.intensity : flux_of(light);
  }
  if (scene.sky) {
    all.push_back(named(scene, scene.sky->light, sky_name, Kind::sky));
    all.back().irradiance = irradiance_of(*scene.sky);
  }
  std::ranges::stable_sort(
      all, [](const LightFacts& a, const LightFacts& b) { return brightest(a.flux) > brightest(b.flux); });
  return all;
}

}  // namespace lichtveld::scene
