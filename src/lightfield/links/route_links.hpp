// route_links: which texel every texel sees along pairs of directions, kept as links. As stencil_routing with a
// scan (thesis, section 4.5), over an A-buffer that holds texel numbers instead of radiance: emit_links, its
// first half, draws the scene into patches of many pairs' rasters at once, an instance each, and appends to
// per-pixel lists; route_links, its second, looks up each texel of the tiles that look into such a patch, and
// leaves what one pixel does not tell to route_doubts and route_rest (docs/algorithm.md). Reads the geometry;
// writes the link table. Costs pixels of the patches times layers, texels of the tiles, and several times that
// for one ray in ten.
#pragma once

#include <span>

#include "links/direct_light.hpp"
#include "links/link_regions.hpp"
#include "links/link_table.hpp"

namespace lichtveld::lightfield {

// What a batch's regions see: lists of layers, of texel number and depth each.
struct LinkStore {
  LinkStore(const gpu::Device& device, const Settings& settings, std::uint32_t capacity);

  std::uint32_t pixels() const { return extent.width * extent.height; }

  StoreExtent extent;      // [pixels]
  std::uint32_t capacity;  // layers of a pixel
  gpu::Buffer filled, layers;
};

// As far above a surface others lie on it [m], before rasters of `pixels` a side.
float contact(const scene::Sphere& sphere, std::uint32_t pixels);

class RouteLinks {
 public:
  RouteLinks(const gpu::Device& device, const LinkStore& store, const LinkTable& table);

  // Reads where the texels are from the geometry texture: whenever that has been drawn again.
  void read_receivers(gpu::Frame& frame, const LightMap& map, const LinkTable& table) const;

  // Writes `cover` of the texels of these groups of the table, for what has been routed.
  void find_cover(gpu::Frame& frame, const Geometry& geometry, const LightMap& map, const LinkTable& table,
                  const gpu::Buffer& directions, std::uint32_t pixels,
                  const std::vector<std::uint32_t>& groups);

  // Counts into `counters` how many of a chunk's links of two pairs, from `pair` on, are others in `again`.
  void compare(gpu::Frame& frame, const LinkTable& table, const LinkTable::Chunk& chunk, std::uint32_t pair,
               const LinkTable::Chunk& again, const gpu::Buffer& counters) const;

  // Where a batch's links go.
  struct Destination {
    std::span<const LinkTable::Chunk> chunks;
    const DirectLight& direct;
    bool keeps_direct;  // direct light follows the links that are replaced
  };

  // Records one batch into the frame, whose links go to the chunks of their pairs; its regions and jobs stay on
  // the device until the next. No two of its regions may be of the same pair. `limit` layers are asked for;
  // pixels with more, misses and unknown rays are added to `counters`.
  void record(gpu::Frame& frame, const RegionBatch& batch, const Geometry& geometry, const LightMap& map,
              const LinkTable& table, const Destination& to, const LinkStore& store, std::uint32_t pixels,
              std::uint32_t limit, const gpu::Buffer& counters);

 private:
  const gpu::Device& device_;
  std::vector<gpu::GraphicsPipeline> draw_;  // one-sided, double-sided
  gpu::ComputePipeline count_, route_, route_doubts_, route_rest_, receive_, cover_, check_;
  gpu::Buffer receivers_;                        // of each valid texel
  gpu::Buffer regions_, jobs_, tiles_, groups_;  // host-visible
  gpu::Buffer doubts_, rest_;                    // rays that are not done with
};

}  // namespace lichtveld::lightfield
