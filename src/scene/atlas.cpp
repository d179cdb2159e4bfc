// check_atlas(): every triangle's TEXCOORD_1 rasterised, to see which texels lie on two charts.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "lichtveld/scene/atlas.hpp"

namespace lichtveld::scene {
namespace {

constexpr std::uint32_t max_size = 16384;

// A chart's triangle as three half-planes n.(u, v) + d >= 0 with unit normals that point inwards.
struct ChartTriangle {
  std::array<glm::dvec3, 3> edges;  // (n, d)
  double top = 0, bottom = 0;       // v
};

std::optional<ChartTriangle> chart_triangle(const Scene& scene, std::size_t first) {
  std::array<glm::dvec2, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = scene.vertices[scene.indices[first + k]].atlas;
  const glm::dvec2 a = p[1] - p[0], b = p[2] - p[0];
  const double area = a.x * b.y - a.y * b.x;
  if (area == 0) return std::nullopt;
  if (area < 0) std::swap(p[1], p[2]);
  ChartTriangle result;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec2 along = p[(k + 1) % 3] - p[k];
    const glm::dvec2 inwards = glm::dvec2(-along.y, along.x) / glm::length(along);
    result.edges[k] = {inwards, -glm::dot(inwards, p[k])};
  }
  result.top = std::min({p[0].y, p[1].y, p[2].y});
  result.bottom = std::max({p[0].y, p[1].y, p[2].y});
  return result;
}

// The texels of row j whose centres lie at least `margin` inside, as [begin, end).
std::pair<std::int64_t, std::int64_t> row_span(const ChartTriangle& triangle, std::int64_t j, std::int64_t size,
                                               double margin) {
  const double n = static_cast<double>(size), v = (static_cast<double>(j) + 0.5) / n;
  double left = 0, right = 1;
  for (const glm::dvec3& edge : triangle.edges) {
    const double rest = edge.y * v + edge.z - margin;  // edge.x * u + rest >= 0
    if (edge.x > 0) left = std::max(left, -rest / edge.x);
    if (edge.x < 0) right = std::min(right, -rest / edge.x);
    if (edge.x == 0 && rest < 0) return {0, 0};
  }
  if (!(left <= right)) return {0, 0};
  const auto begin = static_cast<std::int64_t>(std::ceil(left * n - 0.5));
  const auto end = static_cast<std::int64_t>(std::floor(right * n - 0.5)) + 1;
  return {std::max<std::int64_t>(begin, 0), std::min(end, size)};
}

using Overlaps = std::map<std::pair<std::string, std::string>, std::uint64_t>;

std::string describe(const Overlaps& overlaps) {
  std::vector<std::pair<std::uint64_t, std::string>> lines;
  for (const auto& [nodes, texels] : overlaps) {
    lines.emplace_back(texels,
                       "\"" + nodes.first + "\" and \"" + nodes.second + "\" share " + std::to_string(texels));
  }
  std::ranges::sort(lines, std::greater{});
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(lines.size(), 5); ++i)
    text += (i ? ", " : "") + lines[i].second;
  if (lines.size() > 5) text += " and " + std::to_string(lines.size() - 5) + " more pairs";
  return text;
}

}  // namespace

std::uint32_t check_atlas(const Scene& scene, std::uint32_t size) {
  if (size < 1 || size > max_size)
    throw SceneError("atlas size " + std::to_string(size) + " is outside 1..16384");
  const std::int64_t n = size;
  // Neighbours in a chart meet at edges whose ends were rounded to 32 bits, up to 6e-8 of the atlas: a centre
  // within this distance of an edge is shared by nobody.
  const double margin = 1e-3 / size + 2.5e-7;
  constexpr std::uint32_t no_owner = ~0u;
  std::vector<std::uint32_t> owner(std::size_t{size} * size,
                                   no_owner);  // surface whose triangle holds the centre
  Overlaps overlaps;
  std::uint64_t shared = 0;
  // Enough to describe the damage; a hostile file could stack millions of charts on each other.
  constexpr std::uint64_t enough = 1 << 20;

  for (std::uint32_t s = 0; s < scene.surfaces.size() && shared < enough; ++s) {
    const Surface& surface = scene.surfaces[s];
    for (std::uint32_t t = 0; t < surface.index_count && shared < enough; t += 3) {
      const auto triangle = chart_triangle(scene, surface.first_index + t);
      if (!triangle) continue;
      const auto first = static_cast<std::int64_t>(std::floor(triangle->top * size - 0.5));
      const auto last = static_cast<std::int64_t>(std::ceil(triangle->bottom * size - 0.5));
      for (std::int64_t j = std::max<std::int64_t>(first, 0); j <= std::min(last, n - 1); ++j) {
        const auto [begin, end] = row_span(*triangle, j, n, margin);
        for (std::int64_t i = begin; i < end; ++i) {
          std::uint32_t& held = owner[static_cast<std::size_t>(j * n + i)];
          if (held == no_owner) {
            held = s;
            continue;
          }
          const auto& [a, b] = std::minmax(scene.surfaces[held].node, surface.node);
          ++overlaps[{a, b}];
          ++shared;
        }
      }
    }
  }
  if (shared > 0) {
    throw SceneError(scene.file + ": charts overlap in TEXCOORD_1: " + describe(overlaps) + " of " +
                     std::to_string(size) + " x " + std::to_string(size) + " texels; unwrap without overlaps");
  }
  const auto valid = static_cast<std::uint32_t>(valid_texels(scene, size).size());
  if (valid == 0) {
    throw SceneError(scene.file + ": no texel of " + std::to_string(size) + " x " + std::to_string(size) +
                     " lies on a chart; enlarge the charts in TEXCOORD_1, or bake at a larger size");
  }
  return valid;
}

}  // namespace lichtveld::scene
