#include "lichtveld/scene/surface_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/packing.hpp>

namespace lichtveld::scene {
namespace {

// IEC 61966-2-1, for each of the 8-bit values.
std::array<float, 256> decoded_values() {
  std::array<float, 256> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double encoded = static_cast<double>(i) / 255;
    values[i] =
        static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
  }
  return values;
}

glm::vec3 pixel(const Texture& texture, std::uint32_t x, std::uint32_t y) {
  static const std::array<float, 256> decoded = decoded_values();
  const std::uint8_t* rgba = &texture.rgba[4 * (std::size_t{y} * texture.width + x)];
  return {decoded[rgba[0]], decoded[rgba[1]], decoded[rgba[2]]};
}

// The two pixels around a coordinate along one axis, and the second one's share.
struct Between {
  std::uint32_t first, second;
  float share;
};

// The coordinate in 0..1 that stands for one outside. First of all, so that coordinates far out keep what
// precision they have.
double wrapped(double coordinate, Wrap wrap) {
  if (!std::isfinite(coordinate))
    return 0;  // a hair outside of a triangle whose corners are as far out as can be
  switch (wrap) {
    case Wrap::repeat:
      return coordinate - std::floor(coordinate);
    case Wrap::mirror:
      return 1 - std::abs(coordinate - 2 * std::floor(coordinate / 2) - 1);
    default:
      return std::clamp(coordinate, 0.0, 1.0);
  }
}

Between between(float coordinate, std::uint32_t pixels, Wrap wrap) {
  const double at = wrapped(coordinate, wrap) * pixels - 0.5;
  const double below = std::floor(at);
  // From -1 to pixels - 1; beyond the last pixel is the first one, or what a mirror shows of the last.
  const auto first = static_cast<std::int64_t>(below), last = std::int64_t{pixels} - 1;
  const auto pixel_at = [&](std::int64_t i) {
    const std::int64_t inside =
        wrap == Wrap::repeat ? (i + pixels) % pixels : std::clamp<std::int64_t>(i, 0, last);
    return static_cast<std::uint32_t>(inside);
  };
  return {pixel_at(first), pixel_at(first + 1), static_cast<float>(at - below)};
}

// What `of(texture, x, y)` says of the four pixels around a place, by their shares.
template <typename Of>
auto filtered(const Texture& texture, glm::vec2 at, std::array<Wrap, 2> wrap, const Of& of) {
  const Between x = between(at.x, texture.width, wrap[0]), y = between(at.y, texture.height, wrap[1]);
  const auto upper = glm::mix(of(texture, x.first, y.first), of(texture, x.second, y.first), x.share);
  const auto lower = glm::mix(of(texture, x.first, y.second), of(texture, x.second, y.second), x.share);
  return glm::mix(upper, lower, y.share);
}

}  // namespace

glm::vec3 sample_srgb(const Texture& texture, glm::vec2 at, std::array<Wrap, 2> wrap) {
  return filtered(texture, at, wrap, pixel);
}

float sample_alpha(const Texture& texture, glm::vec2 at, std::array<Wrap, 2> wrap) {
  return filtered(texture, at, wrap, [](const Texture& of, std::uint32_t x, std::uint32_t y) {
    return static_cast<float>(of.rgba[4 * (std::size_t{y} * of.width + x) + 3]) / 255;
  });
}

SurfacePoint pulled_inside(const SurfacePoint& point) {
  const glm::vec2 within = glm::clamp(point.barycentric, 0.0f, 1.0f);
  const float sum = within.x + within.y;
  return {point.triangle, sum > 1 ? within / sum : within};
}

glm::vec3 weights(const SurfacePoint& point) {
  return {1 - point.barycentric.x - point.barycentric.y, point.barycentric.x, point.barycentric.y};
}

Facing facing_of(const Scene& scene, std::uint32_t triangle) {
  const auto corner = [&](std::size_t k) -> const Vertex& {
    return scene.vertices[scene.indices[std::size_t{3} * triangle + k]];
  };
  const Vertex &a = corner(0), &b = corner(1), &c = corner(2);
  const glm::vec3 cross = glm::cross(b.position - a.position, c.position - a.position);
  const float length = glm::length(cross);
  const glm::vec3 face = length > 0 ? cross / length : glm::vec3(0);
  const bool turned = glm::dot(face, a.normal + b.normal + c.normal) < 0;
  return {turned ? -face : face, turned};
}

glm::vec3 albedo_at(const Scene& scene, const Material& material, const SurfacePoint& point) {
  const glm::vec3 w = weights(point);
  glm::vec2 at(0);
  glm::vec3 tint(0);
  for (int corner = 0; corner < 3; ++corner) {
    const std::size_t index = std::size_t{3} * point.triangle + static_cast<std::size_t>(corner);
    const Vertex& vertex = scene.vertices[scene.indices[index]];
    at += w[corner] * vertex.colour;
    tint += w[corner] * glm::vec3(glm::unpackUnorm<float>(vertex.tint));
  }
  glm::vec3 result = material.base_colour * tint;
  if (material.texture >= 0)
    result *= sample_srgb(scene.textures[static_cast<std::size_t>(material.texture)], at, material.wrap);
  return glm::clamp(result, 0.0f, 1.0f);
}

}  // namespace lichtveld::scene
