// Which parts of which pairs' rasters are to be seen again, packed into a store that they share, and the tiles
// of texels that look into them.
#pragma once

#include <vector>

#include "emit_radiance.hpp"
#include "link_table.hpp"

namespace lichtveld::lightfield {

// Extent of the store [pixels].
struct StoreExtent {
  std::uint32_t width, height;
};

// As much as is emitted and routed at once.
struct RegionBatch {
  std::vector<shaders::Region> regions;
  std::vector<std::uint32_t> tiles;     // that look into the regions, region by region
  std::vector<shaders::RouteJob> jobs;  // in the order of the regions' pairs
};

// The whole raster of a pair's view.
shaders::Region whole(const shaders::PsfView& view, std::uint32_t pair, std::uint32_t pixels);

// The part of it that a box in either of two places can change: its projections and what a texel beside them
// looks at. Empty (no columns) where the boxes lie outside the raster.
shaders::Region changed(const shaders::PsfView& view, std::uint32_t pair, std::uint32_t pixels,
                        const scene::Box& before, const scene::Box& after);

// Regions of at most the store's extent each; those of a batch keep the order of their pairs. `tiles` are asked
// only where the `coarse` bounds of several of them look into a region.
std::vector<RegionBatch> pack(std::vector<shaders::Region> regions, const StoreExtent& store,
                              std::uint32_t pixels, const std::vector<TileBounds>& coarse,
                              const std::vector<TileBounds>& tiles);

}  // namespace lichtveld::lightfield
