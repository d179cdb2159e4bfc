#include "lichtveld/scene/lights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lichtveld::scene {

std::vector<std::uint32_t> emitting_triangles(const Scene& scene) {
  std::vector<std::uint32_t> triangles;
  for (const Surface& surface : scene.surfaces)
    if (scene.materials[surface.material].emission != glm::vec3(0))
      for (std::uint32_t corner = 0; corner < surface.index_count; corner += 3)
        triangles.push_back((surface.first_index + corner) / 3);
  return triangles;
}

bool has_light(const Scene& scene) {
  const auto shines = [](const PunctualLight& light) { return light.intensity != glm::vec3(0); };
  return std::ranges::any_of(scene.punctual, shines) || scene.sky || !emitting_triangles(scene).empty();
}

Scales full(const Scene& scene) {
  return Scales(scene.lights.size(), glm::vec3(1));
}

Scene dimmed(Scene scene, const Scales& scales) {
  // Surfaces of other lights may share a material.
  for (auto& surface : scene.surfaces) {
    Material material = scene.materials[surface.material];
    if (scales[surface.light] == glm::vec3(1) || material.emission == glm::vec3(0)) continue;
    material.emission *= scales[surface.light];
    surface.material = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(std::move(material));
  }
  for (auto& light : scene.punctual) light.intensity *= scales[light.light];
  if (scene.sky)
    for (auto& radiance : scene.sky->radiance) radiance *= scales[scene.sky->light];
  return scene;
}

glm::vec3 flux_of(const PunctualLight& light) {
  if (light.kind == PunctualLight::Kind::directional) return glm::vec3(0);
  // A spot gives as much as one without a fade whose cone lies between its two.
  const float solid_angle =
      2 * std::numbers::pi_v<float> *
      (light.kind == PunctualLight::Kind::spot ? 1 - (light.inner_cosine + light.outer_cosine) / 2 : 2.0f);
  return light.intensity * solid_angle;
}

glm::vec3 radiance_of(const Sky& sky, const glm::vec3& direction) {
  constexpr float pi = std::numbers::pi_v<float>;
  const auto at = [](float share, std::uint32_t count) {
    return std::min(static_cast<std::uint32_t>(std::max(share, 0.0f) * static_cast<float>(count)), count - 1);
  };
  const auto column = at(std::atan2(direction.z, direction.x) / (2 * pi) + 0.5f, sky.width),
             row = at(0.5f - std::asin(std::clamp(direction.y, -1.0f, 1.0f)) / pi, sky.height);
  return sky.radiance[std::size_t{row} * sky.width + column];
}

glm::vec3 direction_of(const Sky& sky, std::uint32_t column, std::uint32_t row) {
  constexpr float pi = std::numbers::pi_v<float>;
  const float turn = 2 * pi * ((static_cast<float>(column) + 0.5f) / static_cast<float>(sky.width) - 0.5f),
              rise = pi * (0.5f - (static_cast<float>(row) + 0.5f) / static_cast<float>(sky.height));
  return {std::cos(rise) * std::cos(turn), std::sin(rise), std::cos(rise) * std::sin(turn)};
}

float solid_angle_of(const Sky& sky, std::uint32_t row) {
  constexpr double pi = std::numbers::pi;
  const double top = std::cos(pi * row / sky.height), bottom = std::cos(pi * (row + 1) / sky.height);
  return static_cast<float>((top - bottom) * 2 * pi / sky.width);
}

glm::vec3 mean_radiance(const Sky& sky) {
  glm::dvec3 sum(0);
  for (std::uint32_t pixel = 0; pixel < sky.radiance.size(); ++pixel)
    sum += double{solid_angle_of(sky, pixel / sky.width)} * glm::dvec3(sky.radiance[pixel]);
  return sum / (4 * std::numbers::pi);
}

glm::vec3 irradiance_of(const Sky& sky) {
  // A row's share of the ground's half sphere, cosine and all: sin^2 of its edges apart.
  const auto squared = [&](std::uint32_t edge) {
    const double rise = std::numbers::pi * (0.5 - static_cast<double>(edge) / sky.height);
    return std::pow(std::sin(std::max(rise, 0.0)), 2);
  };
  glm::dvec3 sum(0);
  for (std::uint32_t pixel = 0; pixel < sky.radiance.size(); ++pixel) {
    const std::uint32_t row = pixel / sky.width;
    sum += (squared(row) - squared(row + 1)) * glm::dvec3(sky.radiance[pixel]);
  }
  return std::numbers::pi / sky.width * sum;
}

glm::vec3 towards(const PunctualLight& light, const glm::vec3& offset, const glm::vec3& place) {
  return light.kind == PunctualLight::Kind::directional ? -light.direction
                                                        : glm::normalize(light.place + offset - place);
}

glm::vec3 irradiance_of(const PunctualLight& light, const glm::vec3& offset, const glm::vec3& place,
                        const glm::vec3& normal, const glm::vec3& face) {
  if (light.kind == PunctualLight::Kind::directional) {
    if (glm::dot(face, light.direction) >= 0) return glm::vec3(0);
    return light.intensity * std::max(-glm::dot(normal, light.direction), 0.0f);
  }
  const glm::vec3 way = light.place + offset - place;
  const float distance = glm::length(way);
  if (distance <= 0 || distance >= light.range || glm::dot(face, way) <= 0) return glm::vec3(0);
  const glm::vec3 along = way / distance;
  float share = std::max(glm::dot(normal, along), 0.0f) / (distance * distance);
  if (std::isfinite(light.range)) {
    const float window = 1 - std::pow(distance / light.range, 4.0f);
    share *= window * window;
  }
  if (light.kind == PunctualLight::Kind::spot)
    share *= glm::smoothstep(light.outer_cosine, light.inner_cosine, -glm::dot(along, light.direction));
  return light.intensity * share;
}

}  // namespace lichtveld::scene
