// The light map's atlas at a size: how fine it is, and what it does not show.
#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include "atlas_raster.hpp"
#include "facts.hpp"
#include "triangle.hpp"
#include "unwrap/welding.hpp"

namespace lichtveld::scene {
namespace {

constexpr std::size_t most_marks = 65536;

// For each triangle its chart: those that share a corner in the atlas and in space are of one.
std::vector<std::uint32_t> charts_of(const Scene& scene, const std::vector<std::uint32_t>& indices,
                                     std::size_t& count) {
  Numbers<5> numbers;
  std::vector<std::uint32_t> number_of(scene.vertices.size());
  for (std::size_t v = 0; v < scene.vertices.size(); ++v) {
    const auto& [position, atlas] = std::pair(scene.vertices[v].position, scene.vertices[v].atlas);
    number_of[v] = numbers.of({position.x, position.y, position.z, atlas.x, atlas.y});
  }
  Sets sets(scene.vertices.size());
  for (std::size_t i = 0; i < indices.size(); ++i)
    sets.union_set(number_of[indices[i]], number_of[indices[i / 3 * 3]]);
  std::unordered_map<std::size_t, std::uint32_t> known;
  std::vector<std::uint32_t> charts(indices.size() / 3);
  for (std::size_t t = 0; t < charts.size(); ++t)
    charts[t] =
        known.try_emplace(sets.find_set(number_of[indices[3 * t]]), static_cast<std::uint32_t>(known.size()))
            .first->second;
  count = known.size();
  return charts;
}

// Of numbers with a weight each.
Spread spread_of(std::vector<std::pair<double, double>> weighted) {
  if (weighted.empty()) return {};
  std::ranges::sort(weighted);
  double all = 0, below = 0;
  for (const auto& [value, weight] : weighted) all += weight;
  const auto median = std::ranges::find_if(weighted, [&](const auto& one) {
    below += one.second;
    return below >= all / 2;
  });
  return {weighted.front().first, median == weighted.end() ? weighted.back().first : median->first,
          weighted.back().first};
}

}  // namespace

AtlasFacts atlas_facts(const Scene& scene, const WholeTriangles& whole, std::uint32_t size) {
  AtlasFacts facts;
  facts.size = size;
  facts.shared = shared_texels(scene, size);
  facts.texels = static_cast<std::uint32_t>(valid_texels(scene, size).size());
  const auto charts = charts_of(scene, whole.indices, facts.charts);
  facts.chart_of.assign(std::size_t{size} * size, AtlasFacts::no_chart);
  std::vector<bool> chart_has_texel(facts.charts);
  std::vector<std::pair<double, double>> densities;
  densities.reserve(charts.size());
  struct Unseen {
    std::uint32_t chart;
    glm::vec2 low, high;  // in the atlas
    const std::string* node;
  };
  std::vector<Unseen> unseen;  // triangles
  for (const auto& surface : whole.surfaces)
    for (std::uint32_t t = surface.first_index / 3; t < (surface.first_index + surface.index_count) / 3; ++t) {
      Corners corners;
      std::array<glm::vec2, 3> uv;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& vertex = scene.vertices[whole.indices[std::size_t{3} * t + k]];
        corners[k] = vertex.position;
        uv[k] = vertex.atlas;
      }
      const glm::dvec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
      const double area = area_of(corners), flat = std::abs(a.x * b.y - a.y * b.x) / 2;
      densities.emplace_back(std::sqrt(flat / area) * size, area);
      bool has_texel = false;
      for_texels(uv, size, [&](std::uint32_t column, std::uint32_t row) {
        facts.chart_of[std::size_t{row} * size + column] = charts[t];
        has_texel = true;
      });
      if (has_texel) {
        chart_has_texel[charts[t]] = true;
        continue;
      }
      ++facts.triangles_without_texel;
      facts.area_without_texel += area;
      unseen.push_back({charts[t], glm::min(glm::min(uv[0], uv[1]), uv[2]),
                        glm::max(glm::max(uv[0], uv[1]), uv[2]), &surface.node});
    }
  std::map<std::uint32_t, std::pair<glm::vec2, glm::vec2>> extent;  // of charts without a texel
  for (const auto& [chart, low, high, node] : unseen) {
    if (chart_has_texel[chart]) continue;
    if (extent.empty()) facts.node_without_texel = *node;
    auto& [least, most] = extent.try_emplace(chart, low, high).first->second;
    least = glm::min(least, low);
    most = glm::max(most, high);
  }
  facts.charts_without_texel = extent.size();
  for (const auto& [chart, ends] : extent)
    if (facts.without_texel.size() < most_marks)
      facts.without_texel.push_back((ends.first + ends.second) / 2.0f);
  facts.texels_per_metre = spread_of(std::move(densities));
  return facts;
}

}  // namespace lichtveld::scene
