// Every triangle's TEXCOORD_1 rasterised, to see which texels lie on two charts.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <span>
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

}  // namespace

SharedTexels shared_texels(const Scene& scene, std::uint32_t size) {
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
  std::map<std::pair<std::string, std::string>, std::uint64_t> pairs;
  SharedTexels shared{.pairs = {}, .texels = 0, .at = std::vector<bool>(owners.size())};
  // Enough to describe the damage; a hostile file could stack millions of charts on each other.
  constexpr std::uint64_t enough = 1 << 20;
  const std::uint64_t most_looks = 64 * owners.size();
  std::uint64_t looks = 0;
  const auto may_go_on = [&] { return shared.texels < enough && looks < most_looks; };

  for (std::uint32_t s = 0; s < scene.surfaces.size() && may_go_on(); ++s) {
    const Surface& surface = scene.surfaces[s];
    for (std::uint32_t t = 0; t < surface.index_count && may_go_on(); t += 3) {
      const std::uint32_t number = (surface.first_index + t) / 3;
      const auto triangle = FlatTriangle::of(chart_of(scene, number, size));
      if (!triangle) continue;
      triangle->for_cells(margin, size, [&](std::int64_t i, std::int64_t j) {
        ++looks;
        const auto texel = static_cast<std::size_t>(j * size + i);
        Owner& owner = owners[texel];
        if (owner.triangle != none &&
            !are_copies(corners_of(scene, owner.triangle), corners_of(scene, number))) {
          ++pairs[std::minmax(scene.surfaces[owner.surface].node, surface.node)];
          ++shared.texels;
          shared.at[texel] = true;
        }
        owner = {number, s};
      });
    }
  }
  for (const auto& [nodes, texels] : pairs) shared.pairs.push_back({nodes.first, nodes.second, texels});
  std::ranges::stable_sort(shared.pairs, std::greater{}, &SharedTexels::Pair::texels);
  return shared;
}

std::string text_of(const SharedTexels& shared) {
  constexpr std::size_t most_told = 5;
  std::string text;
  for (const auto& [a, b, texels] : std::span(shared.pairs).first(std::min(shared.pairs.size(), most_told)))
    text += fmt::format("{}\"{}\" and \"{}\" share {}", text.empty() ? "" : ", ", a, b, texels);
  if (shared.pairs.size() > most_told)
    text += fmt::format(" and {} more pairs", shared.pairs.size() - most_told);
  return text;
}

std::uint32_t check_atlas(const Scene& scene, std::uint32_t size) {
  if (const auto shared = shared_texels(scene, size); shared.texels > 0)
    spdlog::warn("{}: charts overlap in TEXCOORD_1: {} of {} x {} texels; each shows what lies on it last",
                 scene.file, text_of(shared), size, size);
  const auto valid = static_cast<std::uint32_t>(valid_texels(scene, size).size());
  if (valid == 0) {
    throw SceneError(scene.file + ": no texel of " + std::to_string(size) + " x " + std::to_string(size) +
                     " lies on a chart; enlarge the charts in TEXCOORD_1, or bake at a larger size");
  }
  return valid;
}

}  // namespace lichtveld::scene
