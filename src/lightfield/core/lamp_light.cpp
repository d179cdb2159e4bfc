#include "core/lamp_light.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "lichtveld/scene/lights.hpp"

namespace lichtveld::lightfield {

namespace {

constexpr std::uint32_t packet = scene::RayPacket::size;
constexpr std::uint32_t samples_of_small = 64, samples_of_large = 256;
// A lamp whose box is this share of the scene's radius across, or more, is large.
constexpr float large = 0.25f;
constexpr std::uint32_t most_lamps = 64;
constexpr std::uint32_t receivers_of_a_task = 256;
// A place lies in a patch's plane if it is this share of what there is in length away from it, or less.
constexpr float in_plane = 2e-7f;
// A ray ends this share of its way before its sample, which lies on a surface.
constexpr float short_of_sample = 1 - 1e-4f;

template <typename Each>
void for_each(std::uint32_t count, const Each& each) {
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, count, receivers_of_a_task),
                    [&](const tbb::blocked_range<std::uint32_t>& some) {
                      for (std::uint32_t i = some.begin(); i < some.end(); ++i) each(i);
                    });
}

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

// What hangs together: triangles that share a corner, of one body.
std::vector<std::uint32_t> components(const scene::Scene& scene, const std::vector<std::uint32_t>& triangles) {
  std::vector<std::uint32_t> parent(triangles.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::map<std::tuple<float, float, float, std::uint32_t>, std::uint32_t> first_at;
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& vertex = scene.vertices[scene.indices[std::size_t{3} * triangles[i] + k]];
      const auto& p = vertex.position;
      const auto [place, is_new] = first_at.try_emplace({p.x, p.y, p.z, vertex.body}, i);
      if (!is_new) parent[std::max(root(i), root(place->second))] = std::min(root(i), root(place->second));
    }
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) found.push_back(root(i));
  return found;
}

}  // namespace

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

LampLight::LampLight(const scene::RayIndex& index, const scene::Scene& scene,
                     std::span<const TexelRecord> receivers, std::function<bool(std::uint32_t)> covered)
    : index_(index),
      scene_(scene),
      receivers_(receivers),
      covered_(std::move(covered)),
      of_body_(scene.bodies.size()),
      irradiance_(receivers.size(), glm::vec3(0)) {
  for (std::uint32_t i = 0; i < receivers.size(); ++i) of_body_[receivers[i].body].push_back(i);
  find_lamps();
}

void LampLight::find_lamps() {
  const auto triangles = scene::emitting_triangles(scene_);
  const auto surfaces = surface_of_triangles(scene_);
  const auto component = components(scene_, triangles);
  std::map<std::uint32_t, std::uint32_t> lamp_of;
  std::set<std::array<float, 9>> known;  // a triangle that is written twice shines once
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const auto& surface = scene_.surfaces[surfaces[triangles[i]]];
    const auto& material = scene_.materials[surface.material];
    const auto corner = [&](std::size_t k) {
      return scene_.vertices[scene_.indices[std::size_t{3} * triangles[i] + k]].position;
    };
    const LampPatch patch{.corner = corner(0),
                          .u = corner(1) - corner(0),
                          .v = corner(2) - corner(0),
                          .emission = material.emission,
                          .triangle = true,
                          .double_sided = material.double_sided};
    if (area_of(patch) <= 0 || !known.insert(turned_to_least({corner(0), corner(1), corner(2)})).second)
      continue;
    const auto [place, is_new] = lamp_of.try_emplace(component[i], static_cast<std::uint32_t>(lamps_.size()));
    if (is_new) {
      lamps_.emplace_back();
      lamps_.back().body = surface.body;
    }
    auto& patches = lamps_[place->second].patches;
    if (!patches.empty() && patches.back().triangle)
      if (const auto both = joined(patches.back(), patch)) {
        patches.back() = *both;
        continue;
      }
    patches.push_back(patch);
  }
  const float radius = scene::bounding_sphere(scene_).radius;
  for (auto& lamp : lamps_) {
    auto& samples = lamp.samples;
    samples.box = {glm::vec3(std::numeric_limits<float>::infinity()),
                   glm::vec3(-std::numeric_limits<float>::infinity())};
    std::vector<float> up_to;
    float power = 0;
    for (const auto& patch : lamp.patches) {
      up_to.push_back(power += area_of(patch) * mean(patch.emission));
      for (const auto& corner : {patch.corner, patch.corner + patch.u, patch.corner + patch.v,
                                 patch.corner + patch.u + (patch.triangle ? glm::vec3(0) : patch.v)}) {
        samples.box.min = glm::min(samples.box.min, corner);
        samples.box.max = glm::max(samples.box.max, corner);
      }
    }
    samples.count =
        glm::length(samples.box.max - samples.box.min) < large * radius ? samples_of_small : samples_of_large;
    for (std::uint32_t i = 0; i < samples.count; ++i) {
      // A lattice by the golden ratio: evenly spread, and its rows are in line with no edge.
      constexpr float golden = 0.61803398875f;
      const float along = (static_cast<float>(i) + 0.5f) / static_cast<float>(samples.count) * power;
      const auto number = static_cast<std::size_t>(
          std::min(std::ranges::lower_bound(up_to, along) - up_to.begin(), std::ssize(up_to) - 1));
      const auto& patch = lamp.patches[number];
      const float before = number > 0 ? up_to[number - 1] : 0;
      const float other = (static_cast<float>(i) + 0.5f) * golden;
      const glm::vec3 place =
          place_on(patch, {(along - before) / (up_to[number] - before), other - std::floor(other)});
      const glm::vec3 normal = glm::normalize(normal_of(patch));
      samples.x.push_back(place.x), samples.y.push_back(place.y), samples.z.push_back(place.z);
      samples.nx.push_back(normal.x), samples.ny.push_back(normal.y), samples.nz.push_back(normal.z);
      samples.double_sided.push_back(patch.double_sided);
    }
    lamp.unshadowed.assign(receivers_.size(), glm::vec3(0));
    lamp.arriving.assign(receivers_.size(), glm::vec3(0));
    lamp.own.assign(receivers_.size(), Bits{});
    lamp.seen = lamp.own;
    lamp.hidden.assign(of_body_.size(), std::vector<std::vector<Hidden>>(of_body_.size()));
  }
}

void LampLight::light(const scene::Offsets& offsets, const Moves& moves,
                      std::span<const std::uint32_t> recovered) {
  offsets_ = offsets;
  touched_.assign(receivers_.size(), false);
  for (auto& lamp : lamps_) light(lamp, moves, recovered);
  for (std::uint32_t i = 0; i < receivers_.size(); ++i) {
    if (!touched_[i]) continue;
    irradiance_[i] = glm::vec3(0);
    for (const auto& lamp : lamps_) irradiance_[i] += lamp.arriving[i];
  }
}

void LampLight::light(Lamp& lamp, const Moves& moves, std::span<const std::uint32_t> recovered) {
  const auto bodies = static_cast<std::uint32_t>(of_body_.size());
  const bool all = moves.has(lamp.body);
  const auto moved = [&](std::uint32_t body) { return all || moves.has(body); };
  std::vector<char> touched(receivers_.size(), 0);
  for (const std::uint32_t receiver : recovered) touched[receiver] = 1;
  for (std::uint32_t body = 1; body < bodies; ++body)
    for (std::uint32_t of = 0; of < bodies; ++of)
      if (moved(body) && !moved(of))
        for (const auto& [receiver, bits] : lamp.hidden[body][of]) {
          lamp.seen[receiver] = lamp.own[receiver];
          touched[receiver] = 2;
        }
  for (std::uint32_t body = 0; body < bodies; ++body) {
    if (!moved(body)) continue;
    const auto& receivers = of_body_[body];
    for_each(static_cast<std::uint32_t>(receivers.size()), [&](std::uint32_t i) {
      find_own(lamp, receivers[i]);
      touched[receivers[i]] = 2;
    });
  }
  for (std::uint32_t of = 0; of < bodies; ++of)
    for (std::uint32_t body = 1; body < bodies; ++body) {
      if (body == of) continue;
      const bool anew = moved(body) || moved(of);
      auto& hidden = lamp.hidden[body][of];
      if (anew) hidden = find_hidden(lamp, body, of);
      for (const auto& [receiver, bits] : hidden) {
        if (!anew && touched[receiver] != 2) continue;
        for (std::size_t word = 0; word < bits.size(); ++word) lamp.seen[receiver][word] &= ~bits[word];
        touched[receiver] = std::max<char>(touched[receiver], 1);
      }
    }
  for_each(static_cast<std::uint32_t>(receivers_.size()), [&](std::uint32_t receiver) {
    if (touched[receiver]) lamp.arriving[receiver] = arriving(lamp, receiver);
  });
  for (std::uint32_t i = 0; i < receivers_.size(); ++i)
    if (touched[i]) touched_[i] = true;
}

void LampLight::find_own(Lamp& lamp, std::uint32_t receiver) const {
  const auto& record = receivers_[receiver];
  const glm::vec3 place = record.position + offsets_[record.body] - offsets_[lamp.body];
  lamp.unshadowed[receiver] = glm::vec3(0);
  for (const auto& patch : lamp.patches)
    lamp.unshadowed[receiver] += irradiance_of(patch, place, record.normal, record.face);
  Bits bits{};
  if (lamp.unshadowed[receiver] != glm::vec3(0)) {
    for (std::uint32_t i = 0; i < lamp.samples.count; i += 64) bits[i / 64] = ~std::uint64_t{0};
    bits = trace(lamp, receiver, 0, bits);
    if (record.body != 0) bits = trace(lamp, receiver, record.body, bits);
  }
  lamp.own[receiver] = lamp.seen[receiver] = bits;
}

// Of the samples that are wanted those that a body does not hide.
LampLight::Bits LampLight::trace(const Lamp& lamp, std::uint32_t receiver, std::uint32_t body,
                                 const Bits& wanted) const {
  const auto& record = receivers_[receiver];
  const auto& samples = lamp.samples;
  const glm::vec3 place = record.position + offsets_[record.body] + index_.skin() / 2 * record.face;
  const glm::vec3 to = offsets_[lamp.body] - place;
  Bits left = wanted;
  scene::RayPacket rays;
  for (std::uint32_t first = 0; first < samples.count; first += packet) {
    rays.lanes = static_cast<std::uint32_t>(wanted[first / 64] >> first % 64 & 0xffff);
    if (rays.lanes == 0) continue;
    for (std::uint32_t lane = 0; lane < packet; ++lane) {
      const std::uint32_t i = first + lane;
      rays.set(lane, place, glm::vec3(samples.x[i], samples.y[i], samples.z[i]) + to);
    }
    left[first / 64] &=
        ~(std::uint64_t{index_.occluded(body, offsets_[body], rays, short_of_sample)} << first % 64);
  }
  return left;
}

std::vector<LampLight::Hidden> LampLight::find_hidden(const Lamp& lamp, std::uint32_t body,
                                                      std::uint32_t of) const {
  const auto& receivers = of_body_[of];
  const auto& samples = lamp.samples;
  const scene::Box& rest = scene_.bodies[body].box;
  const glm::vec3 skin(index_.skin()), low = rest.min + offsets_[body] - skin,
                                       high = rest.max + offsets_[body] + skin;
  const glm::vec3 lamp_low = samples.box.min + offsets_[lamp.body],
                  lamp_high = samples.box.max + offsets_[lamp.body];
  const auto look = [&](std::uint32_t receiver, std::vector<Hidden>& found) {
    const auto& record = receivers_[receiver];
    if (lamp.own[receiver] == Bits{}) return;
    const glm::vec3 place = record.position + offsets_[record.body];
    if (glm::any(glm::greaterThan(glm::min(place, lamp_low), high)) ||
        glm::any(glm::lessThan(glm::max(place, lamp_high), low)))
      return;
    Bits wanted{};
    const glm::vec3 a = low - place, b = high - place, to = offsets_[lamp.body] - place;
    for (std::uint32_t i = 0; i < samples.count; ++i) {
      const float dx = 1 / (samples.x[i] + to.x), dy = 1 / (samples.y[i] + to.y),
                  dz = 1 / (samples.z[i] + to.z);
      const float first = std::max(
          {0.0f, std::min(a.x * dx, b.x * dx), std::min(a.y * dy, b.y * dy), std::min(a.z * dz, b.z * dz)});
      const float last = std::min(
          {1.0f, std::max(a.x * dx, b.x * dx), std::max(a.y * dy, b.y * dy), std::max(a.z * dz, b.z * dz)});
      wanted[i / 64] |= std::uint64_t{!(first > last)} << i % 64;
    }
    Bits hidden{};
    bool any = false;
    for (std::size_t word = 0; word < hidden.size(); ++word) {
      wanted[word] &= lamp.own[receiver][word];
      any = any || wanted[word] != 0;
    }
    if (!any) return;
    const Bits left = trace(lamp, receiver, body, wanted);
    any = false;
    for (std::size_t word = 0; word < hidden.size(); ++word) {
      hidden[word] = wanted[word] & ~left[word];
      any = any || hidden[word] != 0;
    }
    if (any) found.push_back({receiver, hidden});
  };
  const auto count = static_cast<std::uint32_t>(receivers.size());
  std::vector<std::vector<Hidden>> of_task((count + receivers_of_a_task - 1) / receivers_of_a_task);
  tbb::parallel_for(std::size_t{0}, of_task.size(), [&](std::size_t task) {
    const auto first = static_cast<std::uint32_t>(task) * receivers_of_a_task;
    for (auto i = first; i < std::min(first + receivers_of_a_task, count); ++i)
      look(receivers[i], of_task[task]);
  });
  std::vector<Hidden> all;
  for (const auto& some : of_task) all.insert(all.end(), some.begin(), some.end());
  return all;
}

glm::vec3 LampLight::arriving(const Lamp& lamp, std::uint32_t receiver) const {
  const glm::vec3& unshadowed = lamp.unshadowed[receiver];
  if (unshadowed == glm::vec3(0) || covered_(receiver)) return glm::vec3(0);
  const auto& record = receivers_[receiver];
  const auto& samples = lamp.samples;
  const auto& seen = lamp.seen[receiver];
  std::uint32_t bits = 0;
  for (const auto word : seen) bits += static_cast<std::uint32_t>(std::popcount(word));
  if (bits == 0) return glm::vec3(0);
  if (bits == samples.count) return unshadowed;
  const glm::vec3 to = offsets_[lamp.body] - (record.position + offsets_[record.body]);
  float all = 0, visible = 0;
  for (std::uint32_t i = 0; i < samples.count; ++i) {
    const glm::vec3 d = glm::vec3(samples.x[i], samples.y[i], samples.z[i]) + to;
    const float squared = glm::dot(d, d);
    const float here =
        std::max(glm::dot(d, record.normal), 0.0f) * (glm::dot(d, record.face) > 0 ? 1.0f : 0.0f);
    const float out = -(d.x * samples.nx[i] + d.y * samples.ny[i] + d.z * samples.nz[i]);
    const float there = samples.double_sided[i] ? std::abs(out) : std::max(out, 0.0f);
    const float weight = here * there / (squared * squared);
    all += weight;
    visible += (seen[i / 64] >> i % 64 & 1) ? weight : 0.0f;
  }
  // Where no sample shines here, a sliver of the lamp may still.
  const float share = all > 0 ? visible / all : static_cast<float>(bits) / static_cast<float>(samples.count);
  return unshadowed * share;
}

}  // namespace lichtveld::lightfield
