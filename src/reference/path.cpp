// Kajiya 1986, "The Rendering Equation", for diffuse surfaces: with L = Le + albedo / pi * E,
//   E(x) = integral of L(y) (n . w) dw = pi * mean of [Le(y) + albedo(y) / pi * E(y)]
// over directions w that are cosine-distributed, y being what is seen along w. Le is estimated twice, by a
// point on a lamp and by that direction, and both are weighed against each other (Veach 1997, "Robust Monte
// Carlo Methods for Light Transport Simulation", section 9.2). Costs two rays a vertex.
#include "path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lichtveld/scene/lights.hpp"

namespace lichtveld::reference {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

// Paths without a limit run this many segments before chance may end them: the first few carry most of the
// light.
constexpr std::uint32_t sure_segments = 3;
// Chance ends them at least this often, so that they end even between surfaces that lose nothing.
constexpr float most_survivors = 0.95f;

// The power heuristic with exponent 2: Veach 1997, section 9.2.3. `density` is not 0; the other may be without
// end.
float weight_of(double density, double other) {
  const double ratio = other / density;
  return static_cast<float>(1 / (1 + ratio * ratio));
}

// Cosine-distributed about a normal: Malley's method over Shirley and Chiu 1997, "A Low Distortion Map Between
// Disk and Square", in the frame of Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
glm::vec3 cosine_distributed(const glm::vec3& n, glm::dvec2 random) {
  const double x = 2 * random.x - 1, y = 2 * random.y - 1;
  const bool wide = std::abs(x) > std::abs(y);
  const double radius = wide ? x : y, quarter = std::numbers::pi / 4;
  const double angle = wide ? quarter * y / x : y != 0 ? 2 * quarter - quarter * x / y : 0;
  const glm::dvec3 local(radius * std::cos(angle), radius * std::sin(angle),
                         std::sqrt(std::max(0.0, 1 - radius * radius)));
  const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = double{n.x} * n.y * a;
  const glm::dvec3 right(1 + sign * n.x * n.x * a, sign * b, -sign * n.x), up(b, sign + n.y * n.y * a, -n.y);
  return glm::normalize(glm::vec3(local.x * right + local.y * up + local.z * glm::dvec3(n)));
}

}  // namespace

glm::vec3 PathTracer::irradiance(Receiver at, Sampler& sampler, RayCount& count) const {
  glm::vec3 sum(0), share(1);  // share: how much of the E at the vertex arrives at the texel
  for (std::uint32_t segment = 1;; ++segment) {
    sum += share * from_a_lamp(at, sampler.pair());
    if (!geometry_.scene().punctual.empty()) sum += share * from_lights(at, sampler.pair());

    const glm::vec3 direction = cosine_distributed(at.normal, sampler.pair());
    const float cosine = glm::dot(direction, at.normal);
    if (cosine <= 0 || glm::dot(direction, at.face) <= 0) return sum;  // below the face's plane
    const auto hit = embree_.nearest(at, direction);
    if (segment == 1) {
      ++count.rays;
      count.misses += !hit;
    }
    if (!hit) {
      const auto& sky = geometry_.scene().sky;
      return sky ? sum + share * pi * scene::radiance_of(*sky, direction) : sum;
    }
    const glm::vec3& emission = geometry_.material(hit->triangle).emission;
    if (emission != glm::vec3(0))
      sum += share * pi * emission * weight_of(cosine / pi, lamp_density(at, *hit, direction));

    if (segment == bounces_) return sum;
    share *= geometry_.albedo(*hit);
    const float most = std::max({share.r, share.g, share.b});
    if (most <= 0) return sum;
    if (!bounces_ && segment >= sure_segments) {
      // Russian roulette: Arvo and Kirk 1990, "Particle Transport and Image Synthesis", section 4.
      const float survivors = std::min(most, most_survivors);
      if (sampler.pair().x >= survivors) return sum;
      share /= survivors;
    }
    at = geometry_.receiver_seen(*hit, direction);
  }
}

// Next-event estimation: the part of E that one point on a lamp stands for, weighed against cosine-distributed
// directions. Whether the point is seen is asked of the same ray that would have found it, so that both ways
// agree about contact, sides and edges.
glm::vec3 PathTracer::from_a_lamp(const Receiver& at, glm::dvec2 random) const {
  if (lamps_.none()) return glm::vec3(0);
  const Hit lamp = lamps_.sample(random);
  const glm::vec3 across = geometry_.position(lamp) - at.position;
  const float distance = glm::length(across);
  if (distance == 0) return glm::vec3(0);
  const glm::vec3 direction = across / distance;
  const float cosine = glm::dot(direction, at.normal);
  if (cosine <= 0 || glm::dot(direction, at.face) <= 0 || geometry_.is_transparent(lamp.triangle, direction))
    return glm::vec3(0);
  const double density = lamp_density(at, lamp, direction);
  if (density <= 0 || !std::isfinite(density)) return glm::vec3(0);  // seen edge-on, density has no end
  const auto seen = embree_.nearest(at, direction);
  if (!seen || seen->triangle != lamp.triangle) return glm::vec3(0);
  return geometry_.material(lamp.triangle).emission *
         static_cast<float>(cosine / density * weight_of(density, cosine / pi));
}

// E straight from punctual lights: of each all of it or nothing, by a point on the disc that it shows.
glm::vec3 PathTracer::from_lights(const Receiver& at, glm::dvec2 random) const {
  constexpr float short_of_light = 1 - 1e-4f;
  const auto radius = static_cast<float>(std::sqrt(random.x)), turn = static_cast<float>(2 * pi * random.y);
  const glm::vec3 place = geometry_.in_scene(at.position);
  glm::vec3 sum(0);
  for (const auto& light : geometry_.scene().punctual) {
    const glm::vec3 offset = geometry_.offset(light.body);
    const glm::vec3 irradiance = scene::irradiance_of(light, offset, place, at.normal, at.face);
    if (irradiance == glm::vec3(0)) continue;
    const bool sun = light.kind == scene::PunctualLight::Kind::directional;
    const glm::vec3 along = scene::towards(light, offset, place);
    const glm::vec3 right =
        glm::normalize(glm::cross(along, std::abs(along.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
    const glm::vec3 beside = radius * (std::cos(turn) * right + std::sin(turn) * glm::cross(along, right));
    const glm::vec3 way = sun ? along + std::tan(glm::radians(light.angle) / 2) * beside
                              : light.place + offset - place + light.radius * beside;
    const auto hit = embree_.nearest(at, glm::normalize(way));
    if (hit && (sun || geometry_.metres() * glm::distance(geometry_.position(*hit), at.position) <
                           short_of_light * glm::length(way)))
      continue;
    sum += irradiance;
  }
  return sum;
}

// The density with which lamps_ would have chosen that direction [1/sr]: area seen under distance^2 / cosine
// (Veach 1997, section 8.2.2.2).
double PathTracer::lamp_density(const Receiver& at, const Hit& hit, const glm::vec3& direction) const {
  const glm::vec3 across = geometry_.position(hit) - at.position;
  if (glm::dot(across, at.face) <= 0) return 0;  // in contact with the receiver: only directions find it
  const double cosine = std::abs(glm::dot(glm::dvec3(direction), glm::dvec3(geometry_.face(hit.triangle))));
  return lamps_.density(hit.triangle) * double{glm::dot(across, across)} / cosine;
}

}  // namespace lichtveld::reference
