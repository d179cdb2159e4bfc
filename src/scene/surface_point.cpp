#include "lichtveld/scene/surface_point.hpp"

#include <array>
#include <cmath>

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

Between between(float coordinate, std::uint32_t pixels) {
  // Repeats first, so that coordinates far out keep what precision they have.
  const double repeated = double{coordinate} - std::floor(double{coordinate});
  const double at = repeated * pixels - 0.5;
  const double below = std::floor(at);
  const auto first = static_cast<std::uint32_t>(below + pixels) % pixels;
  return {first, (first + 1) % pixels, static_cast<float>(at - below)};
}

}  // namespace

glm::vec3 sample_srgb(const Texture& texture, glm::vec2 at) {
  const Between x = between(at.x, texture.width), y = between(at.y, texture.height);
  const glm::vec3 upper =
      glm::mix(pixel(texture, x.first, y.first), pixel(texture, x.second, y.first), x.share);
  const glm::vec3 lower =
      glm::mix(pixel(texture, x.first, y.second), pixel(texture, x.second, y.second), x.share);
  return glm::mix(upper, lower, y.share);
}

SurfacePoint pulled_inside(const SurfacePoint& point) {
  const glm::vec2 within = glm::clamp(point.barycentric, 0.0f, 1.0f);
  const float sum = within.x + within.y;
  return {point.triangle, sum > 1 ? within / sum : within};
}

glm::vec3 weights(const SurfacePoint& point) {
  return {1 - point.barycentric.x - point.barycentric.y, point.barycentric.x, point.barycentric.y};
}

glm::vec3 albedo_at(const Scene& scene, const Material& material, const SurfacePoint& point) {
  if (material.texture < 0) return material.base_colour;
  const glm::vec3 w = weights(point);
  const auto coordinate = [&](std::size_t corner) {
    return scene.vertices[scene.indices[std::size_t{3} * point.triangle + corner]].colour;
  };
  const glm::vec2 at = w.x * coordinate(0) + w.y * coordinate(1) + w.z * coordinate(2);
  const auto& texture = scene.textures[static_cast<std::size_t>(material.texture)];
  return glm::clamp(material.base_colour * sample_srgb(texture, at), 0.0f, 1.0f);
}

}  // namespace lichtveld::scene
