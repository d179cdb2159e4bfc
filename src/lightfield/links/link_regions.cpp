#include "links/link_regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lichtveld::lightfield {

namespace {

// A texel looks at the centres of the 2 x 2 pixels around it, less than a pixel away in either direction. More
// than that by what a rasteriser snaps its corners to, and by rounding [pixels].
constexpr float reach = 1.02f;

// A workgroup's: to start one costs a CPU device as much as to route some texels, and a GPU wants thousands of
// them.
constexpr std::uint32_t tiles_a_job = 16;
constexpr std::size_t most_jobs = 65535;  // of a batch: every device can start that many

glm::vec2 in_pixels(const shaders::PsfView& view, const glm::vec3& point, float pixels) {
  const glm::vec4 p(point, 1);
  return (glm::vec2(glm::dot(view.right, p), glm::dot(view.up, p)) * 0.5f + 0.5f) * pixels;
}

// The corners of a box where it is and at the end of its way.
std::array<glm::vec3, 16> swept_corners(const scene::Box& box, const glm::vec3& way) {
  std::array<glm::vec3, 16> corners;
  for (int corner = 0; corner < 8; ++corner) {
    corners[corner] = {corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                       corner & 4 ? box.max.z : box.min.z};
    corners[corner + 8] = corners[corner] + way;
  }
  return corners;
}

// A box in all places of its way projects to a polygon whose sides run along its edges and its way: it is the
// intersection of as many slabs. One for an edge that is seen as a point bounds nothing and is left out.
std::vector<Slab> slabs_around(const shaders::PsfView& view, float pixels, const scene::Box& box,
                               const glm::vec3& way, const std::array<glm::vec3, 16>& corners) {
  const glm::vec3 right = glm::vec3(view.right) * pixels / 2.0f, up = glm::vec3(view.up) * pixels / 2.0f;
  const glm::vec3 extent = box.max - box.min;
  std::vector<Slab> slabs;
  for (const glm::vec3& side :
       {glm::vec3(extent.x, 0, 0), glm::vec3(0, extent.y, 0), glm::vec3(0, 0, extent.z), way}) {
    const glm::vec2 across(-glm::dot(up, side), glm::dot(right, side));
    const float length = glm::length(across);
    if (length < 1e-3f) continue;
    const glm::vec2 unit = across / length;
    Slab slab{.normal = unit.x * right + unit.y * up,
              .low = std::numeric_limits<float>::max(),
              .high = std::numeric_limits<float>::lowest()};
    for (const auto& corner : corners) {
      const float at = glm::dot(slab.normal, corner);
      slab.low = std::min(slab.low, at);
      slab.high = std::max(slab.high, at);
    }
    const float beside = reach * (std::abs(unit.x) + std::abs(unit.y));
    slab.low -= beside;
    slab.high += beside;
    slabs.push_back(slab);
  }
  return slabs;
}

bool meet(const std::vector<Slab>& slabs, const TileBoxes::Tile& tile) {
  return std::all_of(slabs.begin(), slabs.end(), [&](const Slab& slab) {
    const float at = glm::dot(slab.normal, tile.centre), half = glm::dot(glm::abs(slab.normal), tile.half);
    return at + half >= slab.low && at - half <= slab.high;
  });
}

std::vector<std::uint32_t> tiles_in(const std::vector<Slab>& slabs, const TileBoxes& tiles) {
  std::vector<std::uint32_t> found;
  for (const auto& group : tiles.groups) {
    if (!meet(slabs, group.around)) continue;
    for (std::uint32_t tile = group.first; tile < group.end; ++tile)
      if (meet(slabs, tiles.tiles[tile])) found.push_back(tile);
  }
  return found;
}

}  // namespace

Patch whole_patch(const shaders::PsfView& view, std::uint32_t pair, std::uint32_t pixels) {
  const auto side = static_cast<int>(pixels);
  return {{.view = view, .rect = {0, 0, side, side}, .store = {0, 0, static_cast<int>(pair), 0}}, {}};
}

Patch changed_patch(const shaders::PsfView& view, std::uint32_t pair, std::uint32_t pixels,
                    const scene::Box& before, const glm::vec3& way) {
  const auto side = static_cast<float>(pixels);
  const auto corners = swept_corners(before, way);
  glm::vec2 low(side), high(0);
  for (const auto& corner : corners) {
    const auto at = in_pixels(view, corner, side);
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  // Of a texel that is as far off, the pixels whose centres lie around it.
  const auto inside = [&](const glm::vec2& at) {
    return glm::clamp(glm::ivec2(glm::floor(at)), glm::ivec2(0), glm::ivec2(pixels));
  };
  const glm::ivec2 first = inside(low - reach - 1.5f), end = glm::max(first, inside(high + reach + 0.5f) + 1);
  const auto last = glm::min(end, glm::ivec2(pixels));
  return {{.view = view, .rect = {first, last - first}, .store = {0, 0, static_cast<int>(pair), 0}},
          slabs_around(view, side, before, way, corners)};
}

std::vector<RegionBatch> pack(const std::vector<Patch>& patches, const StoreExtent& store,
                              const TileBoxes& tiles) {
  std::vector<RegionBatch> batches;
  const auto width = static_cast<int>(store.width), height = static_cast<int>(store.height);
  glm::ivec2 corner(0);  // of the next region: regions stand in rows, as long as they fit
  int row_height = 0;
  for (const auto& [patch, slabs] : patches) {
    auto region = patch;
    const glm::ivec2 extent(region.rect.z, region.rect.w);
    if (extent.x == 0 || extent.y == 0) continue;
    if (corner.x + extent.x > width) {
      corner = {0, corner.y + row_height};
      row_height = 0;
    }
    const auto found = tiles_in(slabs, tiles);
    // Of one region there may be more than that, then of more tiles each.
    const auto each = std::max<std::size_t>(tiles_a_job, (found.size() + most_jobs - 1) / most_jobs),
               jobs = (found.size() + each - 1) / each;
    if (batches.empty() || corner.y + extent.y > height || batches.back().jobs.size() + jobs > most_jobs) {
      batches.emplace_back();
      corner = glm::ivec2(0);
      row_height = 0;
    }
    auto& batch = batches.back();
    region.store.x = corner.x;
    region.store.y = corner.y;
    region.store.w = static_cast<int>(batch.pixels);
    batch.pixels += static_cast<std::uint32_t>(extent.x * extent.y);
    corner.x += extent.x;
    row_height = std::max(row_height, extent.y);
    const auto index = static_cast<std::uint32_t>(batch.regions.size());
    batch.regions.push_back(region);
    const auto first = batch.tiles.size();
    batch.tiles.insert(batch.tiles.end(), found.begin(), found.end());
    for (auto begin = first; begin < batch.tiles.size(); begin += each)
      batch.jobs.push_back({index, static_cast<std::uint32_t>(begin),
                            static_cast<std::uint32_t>(std::min(begin + each, batch.tiles.size()))});
  }
  return batches;
}

std::set<std::uint32_t> groups_beside(const std::vector<scene::Box>& boxes, float gap, const TileBoxes& tiles) {
  std::set<std::uint32_t> found;
  for (std::uint32_t group = 0; group < tiles.groups.size(); ++group) {
    const auto& [centre, half] = tiles.groups[group].around;
    const glm::vec3 low = centre - half, high = centre + half;
    if (std::any_of(boxes.begin(), boxes.end(), [&](const scene::Box& box) {
          return glm::all(glm::lessThanEqual(box.min - gap, high)) &&
                 glm::all(glm::lessThanEqual(low, box.max + gap));
        }))
      found.insert(group);
  }
  return found;
}

}  // namespace lichtveld::lightfield
