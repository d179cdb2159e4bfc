// check_atlas(): every triangle's TEXCOORD_1 rasterised, to see which texels lie on two charts.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "lichtveld/scene/atlas.hpp"
#include "triangle.hpp"
#include "unwrap/flat_triangle.hpp"

namespace lichtveld::scene {
namespace {

constexpr std::uint32_t max_size = 16384;

// A triangle's corners in the atlas [texels].
std::array<glm::dvec2, 3> chart_of(const Scene& scene, std::uint32_t triangle, std::uint32_t size) {
  std::array<glm::dvec2, 3> corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = glm::dvec2(scene.vertices[scene.indices[std::size_t{3} * triangle + k]].atlas) *
                 static_cast<double>(size);
  return corners;
}

Corners corners_of(const Scene& scene, std::uint32_t triangle) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = scene.vertices[scene.indices[std::size_t{3} * triangle + k]].position;
  return corners;
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
  // Neighbours in a chart meet at edges whose ends were rounded to 32 bits, up to 6e-8 of the atlas: a centre
  // within this distance of an edge is shared by nobody.
  const double margin = 1e-3 + 2.5e-7 * size;
  constexpr std::uint32_t none = ~0u;
  struct Owner {
    std::uint32_t triangle = none, surface = 0;
  };
  std::vector<Owner> owners(std::size_t{size} * size);
  Overlaps overlaps;
  std::uint64_t shared = 0;
  // Enough to describe the damage; a hostile file could stack millions of charts on each other.
  constexpr std::uint64_t enough = 1 << 20;

  for (std::uint32_t s = 0; s < scene.surfaces.size() && shared < enough; ++s) {
    const Surface& surface = scene.surfaces[s];
    for (std::uint32_t t = 0; t < surface.index_count && shared < enough; t += 3) {
      const std::uint32_t number = (surface.first_index + t) / 3;
      const auto triangle = FlatTriangle::of(chart_of(scene, number, size));
      if (!triangle) continue;
      triangle->for_cells(margin, size, [&](std::int64_t i, std::int64_t j) {
        Owner& owner = owners[static_cast<std::size_t>(j * size + i)];
        if (owner.triangle != none &&
            !are_copies(corners_of(scene, owner.triangle), corners_of(scene, number))) {
          const auto& [a, b] = std::minmax(scene.surfaces[owner.surface].node, surface.node);
          ++overlaps[{a, b}];
          ++shared;
        }
        owner = {number, s};
      });
    }
  }
  if (shared > 0)
    spdlog::warn("{}: charts overlap in TEXCOORD_1: {} of {} x {} texels; each shows what lies on it last",
                 scene.file, describe(overlaps), size, size);
  const auto valid = static_cast<std::uint32_t>(valid_texels(scene, size).size());
  if (valid == 0) {
    throw SceneError(scene.file + ": no texel of " + std::to_string(size) + " x " + std::to_string(size) +
                     " lies on a chart; enlarge the charts in TEXCOORD_1, or bake at a larger size");
  }
  return valid;
}

}  // namespace lichtveld::scene
