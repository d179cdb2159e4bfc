// Rasterises the charts with the rules of graphics hardware, so that exactly those texels are valid that
// geometry_texture draws: corners snapped to 1/256 texel, and a centre that lies on an edge belongs to the
// triangle below or to the right of it (the top-left rule). The place itself is taken at the exact centre.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "lichtveld/scene/atlas.hpp"

namespace lichtveld::scene {
namespace {

constexpr std::int64_t subtexels = 256;

struct Snapped {
  std::int64_t x, y;  // 1/256 texel
};

Snapped snapped(glm::vec2 atlas, std::uint32_t size) {
  const glm::dvec2 at = glm::dvec2(atlas) * (static_cast<double>(size) * subtexels);
  return {std::llround(at.x), std::llround(at.y)};
}

// Twice the area of (a, b, p): positive where p lies to the right of a -> b on a raster whose y points down.
std::int64_t edge(const Snapped& a, const Snapped& b, const Snapped& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

// Of a triangle that runs clockwise on the raster: a top edge runs right, a left one up.
bool is_top_left(const Snapped& a, const Snapped& b) {
  return a.y == b.y ? b.x > a.x : b.y < a.y;
}

bool covers(const std::array<Snapped, 3>& p, const Snapped& centre) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Snapped &a = p[k], &b = p[(k + 1) % 3];
    const std::int64_t side = edge(a, b, centre);
    if (side < 0 || (side == 0 && !is_top_left(a, b))) return false;
  }
  return true;
}

// The barycentric coordinates of an atlas coordinate.
glm::vec2 barycentric(const std::array<glm::dvec2, 3>& uv, glm::dvec2 at) {
  const glm::dvec2 a = uv[1] - uv[0], b = uv[2] - uv[0], p = at - uv[0];
  const double area = a.x * b.y - a.y * b.x;
  return glm::dvec2((p.x * b.y - p.y * b.x) / area, (a.x * p.y - a.y * p.x) / area);
}

// The texels whose centres can lie between two snapped coordinates, as [begin, end).
std::pair<std::int64_t, std::int64_t> centres_between(std::int64_t low, std::int64_t high, std::uint32_t size) {
  const auto begin = std::clamp<std::int64_t>(low / subtexels - 1, 0, size);
  return {begin, std::clamp<std::int64_t>(high / subtexels + 1, begin, size)};
}

}  // namespace

std::vector<AtlasTexel> valid_texels(const Scene& scene, std::uint32_t size) {
  constexpr std::uint32_t none = ~0u;
  std::vector<SurfacePoint> points(std::size_t{size} * size, SurfacePoint{none, {}});
  const auto triangles = static_cast<std::uint32_t>(scene.indices.size() / 3);
  for (std::uint32_t triangle = 0; triangle < triangles; ++triangle) {
    std::array<glm::dvec2, 3> uv;
    std::array<Snapped, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      uv[k] = scene.vertices[scene.indices[std::size_t{3} * triangle + k]].atlas;
      p[k] = snapped(uv[k], size);
    }
    const std::int64_t area = edge(p[0], p[1], p[2]);
    const glm::dvec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
    if (area == 0 || a.x * b.y == a.y * b.x) continue;
    if (area < 0) std::swap(p[1], p[2]);
    const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [top, bottom] = std::minmax({p[0].y, p[1].y, p[2].y});
    const auto [first_row, end_row] = centres_between(top, bottom, size);
    const auto [first_column, end_column] = centres_between(left, right, size);
    for (std::int64_t j = first_row; j < end_row; ++j)
      for (std::int64_t i = first_column; i < end_column; ++i) {
        if (!covers(p, {i * subtexels + subtexels / 2, j * subtexels + subtexels / 2})) continue;
        const glm::dvec2 centre((static_cast<double>(i) + 0.5) / size, (static_cast<double>(j) + 0.5) / size);
        points[static_cast<std::size_t>(j * size + i)] = {triangle, barycentric(uv, centre)};
      }
  }
  std::vector<AtlasTexel> result;
  for (std::uint32_t index = 0; index < points.size(); ++index)
    if (points[index].triangle != none) result.push_back({index, points[index]});
  return result;
}

}  // namespace lichtveld::scene
