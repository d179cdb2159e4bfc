// Which patches of which pairs' rasters are to be seen again, packed into a store that they share, and the
// tiles of texels that look into them.
#pragma once

#include <set>
#include <vector>

#include "core/psf_view.hpp"
#include "links/link_table.hpp"

namespace lichtveld::lightfield {

// Extent of the store [pixels].
struct StoreExtent {
  std::uint32_t width, height;
};

// The places p [m] with low <= dot(normal, p) <= high.
struct Slab {
  glm::vec3 normal{0};
  float low = 0, high = 0;
};

// A patch of a pair's raster and, as all of these slabs, where a texel is that looks at what may have changed
// there. None: everywhere.
struct Patch {
  shaders::Region region;
  std::vector<Slab> slabs;
};

// The whole raster of a pair's view.
Patch whole_patch(const shaders::PsfView& view, std::uint32_t pair, std::uint32_t pixels);

// What a box changes by moving from one place to another: the projection of all places between, and what a
// texel beside it looks at. Empty (no columns) where that lies outside the raster.
Patch changed_patch(const shaders::PsfView& view, std::uint32_t pair, std::uint32_t pixels,
                    const scene::Box& before, const glm::vec3& way);

// As much as is emitted and routed at once.
struct RegionBatch {
  std::vector<shaders::Region> regions;
  std::uint32_t pixels = 0;             // of the store that they take, from its first on
  std::vector<std::uint32_t> tiles;     // that look into the regions, region by region
  std::vector<shaders::RouteJob> jobs;  // in the order of the regions' pairs
};

// Regions of at most the store's extent each; those of a batch keep the order of their pairs.
std::vector<RegionBatch> pack(const std::vector<Patch>& patches, const StoreExtent& store,
                              const TileBoxes& tiles);

// The groups of tiles that meet any of these boxes, or come within `gap` of it [m].
std::set<std::uint32_t> groups_beside(const std::vector<scene::Box>& boxes, float gap, const TileBoxes& tiles);

}  // namespace lichtveld::lightfield
