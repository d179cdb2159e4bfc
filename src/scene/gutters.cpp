#include "lichtveld/scene/gutters.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "unwrap/flat_triangle.hpp"

namespace lichtveld::scene {

namespace {

constexpr float reads = 1;  // texels along each axis that a bilinear look-up reaches
constexpr int search = 4;   // texels around that are looked at
// A texel whose normal is turned by more, or that is farther off, is another surface's.
constexpr float alike_cosine = 0.7f, most_apart = 4;

// The place of a triangle of the plane that is nearest to another, as weights of its second and third corner.
glm::vec2 nearest(const std::array<glm::vec2, 3>& p, const glm::vec2& to) {
  const glm::vec2 u = p[1] - p[0], v = p[2] - p[0], w = to - p[0];
  const float area = u.x * v.y - u.y * v.x;
  const glm::vec2 inside((w.x * v.y - w.y * v.x) / area, (u.x * w.y - u.y * w.x) / area);
  if (inside.x >= 0 && inside.y >= 0 && inside.x + inside.y <= 1) return inside;
  const std::array<glm::vec2, 3> corners = {glm::vec2(0), {1, 0}, {0, 1}};
  glm::vec2 best(0);
  float least = std::numeric_limits<float>::max();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const glm::vec2 along = p[next] - p[k];
    const float length = glm::dot(along, along);
    const float share = length > 0 ? std::clamp(glm::dot(to - p[k], along) / length, 0.0f, 1.0f) : 0;
    const glm::vec2 apart = to - (p[k] + share * along);
    if (const float distance = glm::dot(apart, apart); distance < least) {
      least = distance;
      best = glm::mix(corners[k], corners[next], share);
    }
  }
  return best;
}

struct Place {
  glm::vec3 position, normal;
  std::uint32_t body;
};

class Gutters {
 public:
  Gutters(const Scene& scene, std::uint32_t size, std::span<const AtlasTexel> valid)
      : scene_(scene),
        size_(static_cast<int>(size)),
        valid_(valid),
        number_(std::size_t{size} * size, no_texel) {
    for (std::uint32_t i = 0; i < valid.size(); ++i) number_[valid[i].index] = i;
  }

  std::vector<std::uint32_t> sources() const {
    std::vector<Beside> beside(number_.size());
    for (std::uint32_t triangle = 0; triangle < scene_.indices.size() / 3; ++triangle)
      find_beside(triangle, beside);
    std::vector<std::uint32_t> sources(number_.size(), no_texel);
    for (std::uint32_t texel = 0; texel < sources.size(); ++texel)
      if (number_[texel] != no_texel)
        sources[texel] = texel;
      else if (beside[texel].at.triangle != no_texel)
        sources[texel] = source(texel, beside[texel]);
    return sources;
  }

 private:
  // A chart's place that is nearest to a texel which is none of its own.
  struct Beside {
    SurfacePoint at{no_texel, {}};
    float distance = std::numeric_limits<float>::max();  // squared [texels]
  };

  const Vertex& corner(std::uint32_t triangle, std::size_t k) const {
    return scene_.vertices[scene_.indices[std::size_t{3} * triangle + k]];
  }

  void find_beside(std::uint32_t triangle, std::vector<Beside>& beside) const {
    std::array<glm::vec2, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = corner(triangle, k).atlas * static_cast<float>(size_) - 0.5f;  // centres are whole numbers
    const glm::vec2 u = p[1] - p[0], v = p[2] - p[0];
    if (u.x * v.y == u.y * v.x) return;
    const auto flat = FlatTriangle::of({p[0] + 0.5f, p[1] + 0.5f, p[2] + 0.5f});
    if (!flat) return;
    flat->for_cells(-std::numbers::sqrt2 * reads, size_, [&](std::int64_t x, std::int64_t y) {
      const auto texel = static_cast<std::size_t>(y * size_ + x);
      if (number_[texel] != no_texel) return;
      const glm::vec2 centre(x, y), at = nearest(p, centre);
      const glm::vec2 apart = glm::abs(p[0] + at.x * u + at.y * v - centre);
      if (std::max(apart.x, apart.y) >= reads) return;
      if (const float distance = glm::dot(apart, apart); distance < beside[texel].distance)
        beside[texel] = {{triangle, at}, distance};
    });
  }

  Place place(const SurfacePoint& at) const {
    const Vertex &a = corner(at.triangle, 0), &b = corner(at.triangle, 1), &c = corner(at.triangle, 2);
    const glm::vec3 w = weights(at);
    return {w.x * a.position + w.y * b.position + w.z * c.position,
            w.x * a.normal + w.y * b.normal + w.z * c.normal, a.body};
  }

  // Metres a texel is wide on a triangle's chart, the longer way.
  float side(std::uint32_t triangle) const {
    float side = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vertex &a = corner(triangle, k), &b = corner(triangle, (k + 1) % 3);
      const float across = glm::distance(a.atlas, b.atlas) * static_cast<float>(size_);
      if (across > 0) side = std::max(side, glm::distance(a.position, b.position) / across);
    }
    return side;
  }

  std::uint32_t source(std::uint32_t texel, const Beside& beside) const {
    const int x = static_cast<int>(texel) % size_, y = static_cast<int>(texel) / size_;
    const Place here = place(beside.at);
    float least = most_apart * side(beside.at.triangle);
    std::uint32_t found = no_texel;
    for (int j = std::max(y - search, 0); j <= std::min(y + search, size_ - 1); ++j)
      for (int i = std::max(x - search, 0); i <= std::min(x + search, size_ - 1); ++i) {
        const auto number = number_[static_cast<std::size_t>(j * size_ + i)];
        if (number == no_texel) continue;
        const Place there = place(valid_[number].at);
        const float distance = glm::distance(here.position, there.position);
        if (distance < least && here.body == there.body &&
            glm::dot(here.normal, there.normal) >
                alike_cosine * glm::length(here.normal) * glm::length(there.normal)) {
          least = distance;
          found = valid_[number].index;
        }
      }
    return found;
  }

  const Scene& scene_;
  int size_;
  std::span<const AtlasTexel> valid_;
  std::vector<std::uint32_t> number_;  // of each atlas texel in valid_
};

}  // namespace

std::vector<std::uint32_t> gutter_sources(const Scene& scene, std::uint32_t size,
                                          std::span<const AtlasTexel> valid) {
  return Gutters(scene, size, valid).sources();
}

}  // namespace lichtveld::scene
