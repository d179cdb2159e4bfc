#include <array>

#include "atlas_raster.hpp"
#include "lichtveld/scene/atlas.hpp"

namespace lichtveld::scene {
namespace {

// The barycentric coordinates of an atlas coordinate.
glm::vec2 barycentric(const std::array<glm::dvec2, 3>& uv, glm::dvec2 at) {
  const glm::dvec2 a = uv[1] - uv[0], b = uv[2] - uv[0], p = at - uv[0];
  const double area = a.x * b.y - a.y * b.x;
  return glm::dvec2((p.x * b.y - p.y * b.x) / area, (a.x * p.y - a.y * p.x) / area);
}

}  // namespace

std::vector<AtlasTexel> valid_texels(const Scene& scene, std::uint32_t size) {
  constexpr std::uint32_t none = ~0u;
  std::vector<SurfacePoint> points(std::size_t{size} * size, SurfacePoint{none, {}});
  const auto triangles = static_cast<std::uint32_t>(scene.indices.size() / 3);
  for (std::uint32_t triangle = 0; triangle < triangles; ++triangle) {
    std::array<glm::vec2, 3> uv;
    for (std::size_t k = 0; k < 3; ++k)
      uv[k] = scene.vertices[scene.indices[std::size_t{3} * triangle + k]].atlas;
    const std::array<glm::dvec2, 3> exact = {uv[0], uv[1], uv[2]};
    for_texels(uv, size, [&](std::uint32_t column, std::uint32_t row) {
      // The place itself is taken at the exact centre.
      const glm::dvec2 centre((column + 0.5) / size, (row + 0.5) / size);
      points[std::size_t{row} * size + column] = {triangle, barycentric(exact, centre)};
    });
  }
  std::vector<AtlasTexel> result;
  for (std::uint32_t index = 0; index < points.size(); ++index)
    if (points[index].triangle != none) result.push_back({index, points[index]});
  return result;
}

}  // namespace lichtveld::scene
