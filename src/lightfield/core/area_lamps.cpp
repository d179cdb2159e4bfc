#include "core/area_lamps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "core/frame.hpp"
#include "core/sky_lamps.hpp"
#include "core/texel_records.hpp"
#include "lichtveld/scene/lights.hpp"

namespace lichtveld::lightfield {

namespace {

// A place lies in a patch's plane if it is this share of what there is in length away from it, or less.
constexpr float in_plane = 2e-7f;

// A convex polygon that planes through the origin cut.
struct Polygon {
  std::array<glm::vec3, 8> corners;
  std::size_t count = 0;

  void clip(const glm::vec3& above) {
    Polygon cut;
    for (std::size_t i = 0; i < count; ++i) {
      const glm::vec3 &a = corners[i], &b = corners[(i + 1) % count];
      const float height_a = glm::dot(a, above), height_b = glm::dot(b, above);
      if (height_a > 0) cut.corners[cut.count++] = a;
      if ((height_a > 0) != (height_b > 0))
        cut.corners[cut.count++] = a + (b - a) * (height_a / (height_a - height_b));
    }
    *this = cut;
  }

  // Lambert's sum over the edges: the integral of the vector towards the polygon over its solid angle, twice.
  glm::vec3 edge_sum() const {
    glm::vec3 sum(0);
    for (std::size_t i = 0; i < count; ++i) {
      const glm::vec3 &a = corners[i], &b = corners[(i + 1) % count];
      const glm::vec3 across = glm::cross(a, b);
      const float length = glm::length(across);
      if (length > 0) sum += across * (std::atan2(length, glm::dot(a, b)) / length);
    }
    return sum;
  }
};

float mean(const glm::vec3& colour) {
  return (colour.r + colour.g + colour.b) / 3;
}

glm::vec3 normal_of(const LampPatch& patch) {
  return glm::cross(patch.u, patch.v);
}

float area_of(const LampPatch& patch) {
  return glm::length(normal_of(patch)) / (patch.triangle ? 2.0f : 1.0f);
}

// A point in the unit square, on the patch.
glm::vec3 place_on(const LampPatch& patch, glm::vec2 at) {
  if (patch.triangle) {
    // Turk 1990, "Generating Random Points in Triangles", Graphics Gems I.
    const float root = std::sqrt(at.x);
    at = {root * (1 - at.y), root * at.y};
  }
  return patch.corner + at.x * patch.u + at.y * patch.v;
}

// Two triangles one after the other that are halves of a parallelogram, as most lamps in rooms are.
std::optional<LampPatch> joined(const LampPatch& a, const LampPatch& b) {
  const std::array corners_a = {a.corner, a.corner + a.u, a.corner + a.v},
                   corners_b = {b.corner, b.corner + b.u, b.corner + b.v};
  const float close = 1e-5f * (glm::length(a.u) + glm::length(a.v));
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      // The shared edge runs from the one's corner i + 1 to i + 2, the other one's the other way.
      const glm::vec3 &tip_a = corners_a[i], &first = corners_a[(i + 1) % 3], &second = corners_a[(i + 2) % 3];
      const glm::vec3 &tip_b = corners_b[j], &third = corners_b[(j + 1) % 3], &fourth = corners_b[(j + 2) % 3];
      if (glm::distance(first, fourth) > close || glm::distance(second, third) > close ||
          glm::distance(first + second, tip_a + tip_b) > close || a.emission != b.emission)
        continue;
      return LampPatch{.corner = tip_a,
                       .u = first - tip_a,
                       .v = second - tip_a,
                       .emission = a.emission,
                       .triangle = false,
                       .double_sided = a.double_sided};
    }
  return std::nullopt;
}

// The same for each of a triangle's three ways to be written with that front.
std::array<float, 9> turned_to_least(const std::array<glm::vec3, 3>& corners) {
  std::array<float, 9> least;
  for (std::size_t first = 0; first < 3; ++first) {
    std::array<float, 9> turned;
    for (std::size_t i = 0; i < 9; ++i) turned[i] = corners[(first + i / 3) % 3][static_cast<int>(i % 3)];
    if (first == 0 || std::ranges::lexicographical_compare(turned, least)) least = turned;
  }
  return least;
}

// What hangs together: triangles that share a corner, of one body and light.
std::vector<std::uint32_t> components(const scene::Scene& scene, const std::vector<std::uint32_t>& triangles,
                                      const std::vector<std::uint32_t>& surfaces) {
  std::vector<std::uint32_t> parent(triangles.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::map<std::tuple<float, float, float, std::uint32_t, std::uint32_t>, std::uint32_t> first_at;
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& vertex = scene.vertices[scene.indices[std::size_t{3} * triangles[i] + k]];
      const auto& p = vertex.position;
      const auto [place, is_new] =
          first_at.try_emplace({p.x, p.y, p.z, vertex.body, scene.surfaces[surfaces[triangles[i]]].light}, i);
      if (!is_new) parent[std::max(root(i), root(place->second))] = std::min(root(i), root(place->second));
    }
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) found.push_back(root(i));
  return found;
}

// Halves lamps by where they lie until there are so many groups, and makes one of each.
void group(std::vector<AreaLamp> lamps, std::size_t groups, std::vector<AreaLamp>& found) {
  if (groups <= 1 || lamps.size() <= 1) {
    for (std::size_t i = 1; i < lamps.size(); ++i)
      lamps[0].patches.insert(lamps[0].patches.end(), lamps[i].patches.begin(), lamps[i].patches.end());
    found.push_back(std::move(lamps[0]));
    return;
  }
  glm::vec3 low(std::numeric_limits<float>::infinity()), high(-low);
  for (const auto& lamp : lamps) {
    low = glm::min(low, lamp.patches[0].corner);
    high = glm::max(high, lamp.patches[0].corner);
  }
  const glm::vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::ranges::stable_sort(lamps, {}, [&](const AreaLamp& lamp) { return lamp.patches[0].corner[axis]; });
  const auto middle = lamps.begin() + std::ssize(lamps) / 2;
  group({lamps.begin(), middle}, groups / 2, found);
  group({middle, lamps.end()}, groups - groups / 2, found);
}

std::vector<AreaLamp> grouped(const std::vector<AreaLamp>& lamps, std::size_t most) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<AreaLamp>> together;
  for (const auto& lamp : lamps) together[{lamp.body, lamp.light}].push_back(lamp);
  std::vector<AreaLamp> found;
  for (const auto& [owners, some] : together)
    group(some, std::max<std::size_t>(some.size() * most / lamps.size(), 1), found);
  return found;
}

// Evenly over the disc that a sun far away is, or over a sphere (Vogel 1979): the golden angle from one to the
// next.
void place_samples(AreaLamp& lamp, const scene::Sphere& around) {
  const auto& light = *lamp.punctual;
  const bool sun = light.kind == scene::PunctualLight::Kind::directional;
  const glm::vec3 middle = sun ? around.centre - far_away * around.radius * light.direction : light.place;
  const float radius = sun ? far_away * around.radius * std::tan(glm::radians(light.angle) / 2) : light.radius;
  const glm::mat3 frame = frame_about(sun ? -light.direction : glm::vec3(0, 1, 0));
  lamp.box = {middle - radius, middle + radius};
  LampSamples& samples = lamp.samples.emplace_back();
  for (std::uint32_t i = 0; i < samples_of_lamp; ++i) {
    const float at = (static_cast<float>(i) + 0.5f) / static_cast<float>(samples_of_lamp),
                turn = static_cast<float>(i) * 2.39996323f, height = sun ? 0 : 1 - 2 * at,
                away = sun ? std::sqrt(at) : std::sqrt(1 - height * height);
    const glm::vec3 place =
        middle + radius * (frame * glm::vec3(away * std::cos(turn), away * std::sin(turn), height));
    samples.x[i] = place.x, samples.y[i] = place.y, samples.z[i] = place.z;
    samples.intensity[i] = light.intensity / static_cast<float>(samples_of_lamp);
  }
}

}  // namespace

void place_samples(AreaLamp& lamp, const glm::vec2& shift) {
  lamp.box = {glm::vec3(std::numeric_limits<float>::infinity()),
              glm::vec3(-std::numeric_limits<float>::infinity())};
  std::vector<float> up_to;
  float power = 0;
  for (const auto& patch : lamp.patches) {
    up_to.push_back(power += area_of(patch) * mean(patch.emission));
    for (const auto& corner : {patch.corner, patch.corner + patch.u, patch.corner + patch.v,
                               patch.corner + patch.u + (patch.triangle ? glm::vec3(0) : patch.v)}) {
      lamp.box.min = glm::min(lamp.box.min, corner);
      lamp.box.max = glm::max(lamp.box.max, corner);
    }
  }
  auto& samples = lamp.samples.emplace_back();
  for (std::uint32_t i = 0; i < samples_of_lamp; ++i) {
    // A lattice by the golden ratio: evenly spread, and its rows are in line with no edge.
    constexpr float golden = 0.61803398875f;
    const float along = (static_cast<float>(i) + 0.5f + shift.x) / static_cast<float>(samples_of_lamp) * power;
    const auto number = static_cast<std::size_t>(
        std::min(std::ranges::lower_bound(up_to, along) - up_to.begin(), std::ssize(up_to) - 1));
    const auto& patch = lamp.patches[number];
    const float before = number > 0 ? up_to[number - 1] : 0;
    const float other = (static_cast<float>(i) + 0.5f) * golden + shift.y;
    const glm::vec3 place =
        place_on(patch, {(along - before) / (up_to[number] - before), other - std::floor(other)});
    const glm::vec3 normal = glm::normalize(normal_of(patch));
    samples.x[i] = place.x, samples.y[i] = place.y, samples.z[i] = place.z;
    samples.nx[i] = normal.x, samples.ny[i] = normal.y, samples.nz[i] = normal.z;
    samples.back[i] = patch.double_sided ? -1.0f : 0.0f;
    samples.intensity[i] = patch.emission / mean(patch.emission) * power / static_cast<float>(samples_of_lamp);
  }
}

std::vector<LampSamples> middles_of(const std::vector<LampPatch>& patches) {
  std::vector<LampSamples> found;
  for (std::size_t number = 0; number < patches.size(); ++number) {
    const std::size_t i = number % samples_of_lamp;
    if (i == 0) found.emplace_back();
    auto& to = found.back();
    const auto& patch = patches[number];
    const glm::vec3 place = patch.corner + (patch.u + patch.v) / (patch.triangle ? 3.0f : 2.0f),
                    normal = glm::normalize(normal_of(patch));
    to.x[i] = place.x, to.y[i] = place.y, to.z[i] = place.z;
    to.nx[i] = normal.x, to.ny[i] = normal.y, to.nz[i] = normal.z;
    to.back[i] = patch.double_sided ? -1.0f : 0.0f;
    to.intensity[i] = area_of(patch) * patch.emission;
  }
  return found;
}

glm::vec3 irradiance_of(const LampPatch& patch, const glm::vec3& place, const glm::vec3& normal,
                        const glm::vec3& face) {
  const glm::vec3 corner = patch.corner - place;
  const float side =
      glm::dot(normal_of(patch), corner);  // the front turns towards the place where this is below 0
  // In the patch's own plane, by rounding.
  const float size = glm::length(patch.u) + glm::length(patch.v) + glm::length(corner);
  if (std::abs(side) <= in_plane * size * glm::length(normal_of(patch))) return glm::vec3(0);
  if (side > 0 && !patch.double_sided) return glm::vec3(0);
  Polygon polygon;
  polygon.corners = {corner, corner + patch.u, corner + patch.u + patch.v, corner + patch.v};
  polygon.count = 4;
  if (patch.triangle) polygon.corners[2] = polygon.corners[3], polygon.count = 3;
  polygon.clip(face);
  if (normal != face) polygon.clip(normal);
  const float sum = glm::dot(polygon.edge_sum(), normal) * (side < 0 ? -0.5f : 0.5f);
  return patch.emission * std::max(sum, 0.0f);
}

std::vector<AreaLamp> find_area_lamps(const scene::Scene& scene, std::size_t most, std::uint32_t sets) {
  std::vector<AreaLamp> lamps;
  const auto triangles = scene::emitting_triangles(scene);
  const auto surfaces = surface_of_triangles(scene);
  const auto component = components(scene, triangles, surfaces);
  std::map<std::uint32_t, std::uint32_t> lamp_of;
  std::set<std::array<float, 9>> known;  // a triangle that is written twice shines once
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const auto& surface = scene.surfaces[surfaces[triangles[i]]];
    const auto& material = scene.materials[surface.material];
    const auto corner = [&](std::size_t k) {
      return scene.vertices[scene.indices[std::size_t{3} * triangles[i] + k]].position;
    };
    const LampPatch patch{.corner = corner(0),
                          .u = corner(1) - corner(0),
                          .v = corner(2) - corner(0),
                          .emission = material.emission,
                          .triangle = true,
                          .double_sided = material.double_sided};
    if (area_of(patch) <= 0 || !known.insert(turned_to_least({corner(0), corner(1), corner(2)})).second)
      continue;
    const auto [place, is_new] = lamp_of.try_emplace(component[i], static_cast<std::uint32_t>(lamps.size()));
    if (is_new) {
      lamps.emplace_back();
      lamps.back().body = surface.body;
      lamps.back().light = surface.light;
    }
    auto& patches = lamps[place->second].patches;
    if (!patches.empty() && patches.back().triangle)
      if (const auto both = joined(patches.back(), patch)) {
        patches.back() = *both;
        continue;
      }
    patches.push_back(patch);
  }
  if (lamps.size() > most) lamps = grouped(lamps, most);
  for (auto& lamp : lamps) place_samples(lamp);
  const auto sphere = scene::bounding_sphere(scene);
  for (const auto& light : scene.punctual) {
    if (light.intensity == glm::vec3(0)) continue;
    auto& lamp = lamps.emplace_back();
    lamp.body = light.body;
    lamp.light = light.light;
    lamp.punctual = light;
    place_samples(lamp, sphere);
  }
  if (scene.sky)
    for (auto& lamp : sky_lamps(*scene.sky, sphere, sets)) lamps.push_back(std::move(lamp));
  return lamps;
}

}  // namespace lichtveld::lightfield
