#include "link_regions.hpp"

#include <algorithm>
#include <cmath>

namespace lichtveld::lightfield {

namespace {

// Around a projection [pixels]: a texel looks at centres up to one pixel away, on either side of what changed,
// and the nearest of them may be rounded.
constexpr float margin = 3;

// A workgroup's: to start one costs a CPU device as much as to route some texels, and a GPU wants thousands of
// them.
constexpr std::uint32_t tiles_a_job = 16;

glm::vec2 in_pixels(const shaders::PsfView& view, const glm::vec3& point, float pixels) {
  const glm::vec4 p(point, 1);
  return (glm::vec2(glm::dot(view.right, p), glm::dot(view.up, p)) * 0.5f + 0.5f) * pixels;
}

bool looks_into(const TileBounds& tile, const shaders::Region& region, float pixels) {
  const glm::vec2 centre = in_pixels(region.view, tile.centre, pixels);
  const float reach = tile.radius * glm::length(glm::vec3(region.view.right)) * pixels / 2 + 2;
  const glm::vec2 low(region.rect.x, region.rect.y),
      high(region.rect.x + region.rect.z, region.rect.y + region.rect.w);
  return glm::all(glm::greaterThan(centre + reach, low)) && glm::all(glm::lessThan(centre - reach, high));
}

}  // namespace

shaders::Region whole(const shaders::PsfView& view, std::uint32_t pair, std::uint32_t pixels) {
  const auto side = static_cast<int>(pixels);
  return {.view = view, .rect = {0, 0, side, side}, .place = {0, 0, static_cast<int>(pair), 0}};
}

shaders::Region changed(const shaders::PsfView& view, std::uint32_t pair, std::uint32_t pixels,
                        const scene::Box& before, const scene::Box& after) {
  glm::vec2 low(static_cast<float>(pixels)), high(0);
  for (const auto* box : {&before, &after})
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 point(corner & 1 ? box->max.x : box->min.x, corner & 2 ? box->max.y : box->min.y,
                            corner & 4 ? box->max.z : box->min.z);
      const auto at = in_pixels(view, point, static_cast<float>(pixels));
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
  const glm::ivec2 first = glm::clamp(glm::ivec2(glm::floor(low - margin)), glm::ivec2(0), glm::ivec2(pixels));
  const glm::ivec2 end = glm::clamp(glm::ivec2(glm::ceil(high + margin)), first, glm::ivec2(pixels));
  return {.view = view, .rect = {first, end - first}, .place = {0, 0, static_cast<int>(pair), 0}};
}

std::vector<RegionBatch> pack(std::vector<shaders::Region> regions, const StoreExtent& store,
                              std::uint32_t pixels, const std::vector<TileBounds>& coarse,
                              const std::vector<TileBounds>& tiles) {
  const std::size_t each = coarse.empty() ? 1 : (tiles.size() + coarse.size() - 1) / coarse.size();
  std::vector<RegionBatch> batches;
  const auto width = static_cast<int>(store.width), height = static_cast<int>(store.height);
  glm::ivec2 corner(0);  // of the next region: regions stand in rows, as long as they fit
  int row_height = 0;
  for (auto& region : regions) {
    const glm::ivec2 extent(region.rect.z, region.rect.w);
    if (extent.x == 0 || extent.y == 0) continue;
    if (corner.x + extent.x > width) {
      corner = {0, corner.y + row_height};
      row_height = 0;
    }
    if (batches.empty() || corner.y + extent.y > height) {
      batches.emplace_back();
      corner = glm::ivec2(0);
      row_height = 0;
    }
    region.place.x = corner.x;
    region.place.y = corner.y;
    corner.x += extent.x;
    row_height = std::max(row_height, extent.y);
    auto& batch = batches.back();
    const auto index = static_cast<std::uint32_t>(batch.regions.size());
    batch.regions.push_back(region);
    const auto first = static_cast<std::uint32_t>(batch.tiles.size());
    const auto side = static_cast<float>(pixels);
    for (std::size_t group = 0; group < coarse.size(); ++group) {
      if (!looks_into(coarse[group], region, side)) continue;
      for (std::size_t tile = group * each; tile < std::min((group + 1) * each, tiles.size()); ++tile)
        if (looks_into(tiles[tile], region, side)) batch.tiles.push_back(static_cast<std::uint32_t>(tile));
    }
    const auto end = static_cast<std::uint32_t>(batch.tiles.size());
    for (auto begin = first; begin < end; begin += tiles_a_job)
      batch.jobs.push_back({index, begin, std::min(begin + tiles_a_job, end)});
  }
  return batches;
}

}  // namespace lichtveld::lightfield
