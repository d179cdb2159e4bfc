#include "links/route_links.hpp"

#include <algorithm>

#include "passes/draw_scene.hpp"
#include "shaders/emit_links.frag.h"
#include "shaders/emit_links.vert.h"
#include "shaders/emit_links_count.comp.h"
#include "shaders/link_check.comp.h"
#include "shaders/link_cover.comp.h"
#include "shaders/receivers.comp.h"
#include "shaders/route_doubts.comp.h"
#include "shaders/route_links_16.comp.h"
#include "shaders/route_links_32.comp.h"
#include "shaders/route_rest_16.comp.h"
#include "shaders/route_rest_32.comp.h"

namespace lichtveld::lightfield {

namespace {

// A store of this size holds what a moved cube changes in 384 directions at 256 pixels, and is cleared in a
// fraction of a millisecond [bytes].
constexpr std::uint64_t usual_store = 64 << 20;
// Pairs that decide whether a texel is covered; it sees steeply along half of them.
constexpr std::uint32_t cover_votes = 24;
constexpr std::uint32_t widest_store = 4096;  // [pixels]; every device renders that
// Workgroups of what the device itself counts how much there is to do of.
constexpr std::uint32_t many_groups = 256;
// Of a struct that shaders fetch row by row.
constexpr auto rows = vk::Format::eR32G32B32A32Uint;

StoreExtent store_extent(const gpu::Device& device, std::uint32_t pixels, std::uint32_t capacity) {
  const std::uint64_t a_pixel = std::uint64_t{capacity} * 2 * sizeof(std::uint32_t),
                      a_raster = std::uint64_t{pixels} * pixels * a_pixel;
  if (a_raster > device.summary().max_storage_buffer)
    throw std::runtime_error("an A-buffer of " + std::to_string(capacity) + " layers at " +
                             std::to_string(pixels) + " pixels a side takes " + std::to_string(a_raster >> 20) +
                             " MiB, more than the device's " +
                             std::to_string(device.summary().max_storage_buffer >> 20) +
                             " MiB for one buffer; try a smaller --psf-size or --size");
  const auto rasters = static_cast<std::uint32_t>(std::max<std::uint64_t>(1, usual_store / a_raster));
  const std::uint32_t columns = std::clamp(widest_store / pixels, 1u, rasters);
  return {columns * pixels, std::max(1u, rasters / columns) * pixels};
}

// The whole raster at its place, of which the region is visible: nothing is cut off where a region ends, which
// would round edges anew, so that a region is exactly that part of the raster.
gpu::Window window_of(const shaders::Region& region, std::uint32_t pixels) {
  return {.offset = {region.store.x - region.rect.x, region.store.y - region.rect.y},
          .extent = {pixels, pixels},
          .visible = {{region.store.x, region.store.y},
                      {static_cast<std::uint32_t>(region.rect.z), static_cast<std::uint32_t>(region.rect.w)}}};
}

gpu::Buffer host_buffer(const gpu::Device& device, const char* name,
                        vk::Format texels = vk::Format::eUndefined) {
  return {device, name, sizeof(shaders::Region), vk::BufferUsageFlagBits::eStorageBuffer, gpu::Memory::host,
          texels};
}

}  // namespace

float contact(const scene::Sphere& sphere, std::uint32_t pixels) {
  return shaders::CONTACT * 2 * sphere.radius / static_cast<float>(pixels);
}

LinkStore::LinkStore(const gpu::Device& device, const Settings& settings, std::uint32_t capacity)
    : extent(store_extent(device, settings.raster(), capacity)),
      capacity(capacity),
      filled(device, "lightfield/link_layers_filled",
             vk::DeviceSize{extent.width} * extent.height * sizeof(std::uint32_t),
             vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst),
      layers(device, "lightfield/link_layers",
             vk::DeviceSize{extent.width} * extent.height * capacity * 2 * sizeof(std::uint32_t),
             vk::BufferUsageFlagBits::eStorageBuffer) {}

RouteLinks::RouteLinks(const gpu::Device& device, const LinkStore& store, const LinkTable& table)
    : device_(device),
      count_(device, "emit_links_count", shaders::emit_links_count_comp),
      route_(device, "route_links",
             table.bits == 16 ? shaders::route_links_16_comp : shaders::route_links_32_comp,
             {store.capacity, table.tile}),
      route_doubts_(device, "route_doubts", shaders::route_doubts_comp, {store.capacity, table.tile}),
      route_rest_(device, "route_rest",
                  table.bits == 16 ? shaders::route_rest_16_comp : shaders::route_rest_32_comp,
                  {store.capacity, table.tile}),
      receive_(device, "receivers", shaders::receivers_comp),
      cover_(device, "link_cover", shaders::link_cover_comp, {table.bits}),
      check_(device, "link_check", shaders::link_check_comp, {table.bits}),
      receivers_(device, "lightfield/receivers", table.texels * sizeof(shaders::Receiver),
                 vk::BufferUsageFlagBits::eStorageBuffer, gpu::Memory::device, rows),
      regions_(host_buffer(device, "lightfield/regions", rows)),
      jobs_(host_buffer(device, "lightfield/jobs")),
      tiles_(host_buffer(device, "lightfield/tiles")),
      groups_(host_buffer(device, "lightfield/covered_groups")),
      doubts_(device, "lightfield/doubts", sizeof(glm::uvec2), vk::BufferUsageFlagBits::eStorageBuffer),
      rest_(device, "lightfield/rest", sizeof(glm::uvec2), vk::BufferUsageFlagBits::eStorageBuffer) {
  for (const std::uint32_t double_sided : {0u, 1u})
    draw_.emplace_back(device, "emit_links", shaders::emit_links_vert, shaders::emit_links_frag, scene_state(),
                       gpu::Specialisation{double_sided});
}

void RouteLinks::read_receivers(gpu::Frame& frame, const LightMap& map, const LinkTable& table) const {
  frame.compute(receive_,
                {gpu::reads("TexelOf", table.texel_of), gpu::reads("position", map.position),
                 gpu::reads("normal", map.normal), gpu::reads("face_normal", map.face_normal),
                 gpu::reads("near_walls", map.near_walls), gpu::writes("Receivers", receivers_)},
                shaders::ReceiveConstants{.texels = table.texels}, table.groups(), 1);
}

void RouteLinks::find_cover(gpu::Frame& frame, const Geometry& geometry, const LightMap& map,
                            const LinkTable& table, const gpu::Buffer& directions, std::uint32_t pixels,
                            const std::vector<std::uint32_t>& groups) {
  gpu::put<std::uint32_t>(device_, groups_, groups);
  const auto& chunk = table.chunks.front();
  frame.compute(
      cover_,
      {gpu::reads("Table", chunk.links), gpu::fetches("directions", directions),
       gpu::fetches("receivers", receivers_), gpu::writes("cover", map.cover), gpu::reads("Groups", groups_)},
      shaders::CoverConstants{.texels = table.texels,
                              .pairs = chunk.pairs,
                              .votes = std::min(chunk.pairs, cover_votes),
                              .contact = contact(geometry.sphere, pixels)},
      static_cast<std::uint32_t>(groups.size()), 1);
}

void RouteLinks::compare(gpu::Frame& frame, const LinkTable& table, const LinkTable::Chunk& chunk,
                         std::uint32_t pair, const LinkTable::Chunk& again, const gpu::Buffer& counters) const {
  const std::uint32_t a_word = 32 / table.bits;  // pairs
  frame.compute(check_,
                {gpu::reads("Table", chunk.links), gpu::reads("Again", again.links),
                 gpu::writes("Counted", counters), gpu::reads("TexelOf", table.texel_of)},
                shaders::CheckConstants{.texels = table.texels,
                                        .size = table.number.extent().width,
                                        .first_word = (pair - chunk.first_pair) / a_word,
                                        .words = chunk.pairs / a_word},
                many_groups, 1);
}

void RouteLinks::record(gpu::Frame& frame, const RegionBatch& batch, const Geometry& geometry,
                        const LightMap& map, const LinkTable& table, const Destination& to,
                        const LinkStore& store, std::uint32_t pixels, std::uint32_t limit,
                        const gpu::Buffer& counters) {
  gpu::put<shaders::Region>(device_, regions_, batch.regions);
  gpu::put<shaders::RouteJob>(device_, jobs_, batch.jobs);
  gpu::put<std::uint32_t>(device_, tiles_, batch.tiles);
  const auto bytes = batch.tiles.size() * table.tile * sizeof(glm::uvec2);
  for (auto* list : {&doubts_, &rest_})
    if (bytes > list->size())
      *list = gpu::Buffer(device_, list->name(), bytes, vk::BufferUsageFlagBits::eStorageBuffer);

  frame.clear("emit_links", store.filled);
  const std::vector bindings = {gpu::reads("Offsets", geometry.offsets), gpu::fetches("regions", regions_),
                                gpu::reads("number", table.number), gpu::writes("Filled", store.filled),
                                gpu::writes("Layers", store.layers)};
  const shaders::EmitLinksConstants emit{
      .size = pixels, .store_pixels = store.pixels(), .capacity = store.capacity, .windows = gpu::most_windows};
  frame.render("emit_links", {.extent = {store.extent.width, store.extent.height}}, bindings,
               {&geometry.vertices, &geometry.indices}, [&](gpu::Draw& draw) {
                 const auto count = static_cast<std::uint32_t>(batch.regions.size());
                 for (std::uint32_t first = 0; first < count; first += gpu::most_windows) {
                   const auto end = std::min(first + gpu::most_windows, count);
                   std::vector<gpu::Window> windows;
                   for (auto index = first; index < end; ++index)
                     windows.push_back(window_of(batch.regions[index], pixels));
                   draw.windows(windows);
                   draw_scene(draw, draw_, geometry, bindings, emit, end - first, first);
                 }
               });
  frame.compute(count_, {gpu::reads("Filled", store.filled), gpu::writes("Counted", counters)},
                shaders::CountLayersConstants{.pixels = batch.pixels, .limit = limit}, many_groups, 1);

  const auto lamps = to.keeps_direct ? to.direct.linked_lamps() : 0u;
  const auto look = [&](const gpu::ComputePipeline& pipeline, const LinkTable::Chunk& chunk,
                        std::vector<gpu::Binding> bindings, std::uint32_t first_job, std::uint32_t groups) {
    bindings.insert(bindings.end(), {gpu::fetches("regions", regions_), gpu::fetches("receivers", receivers_),
                                     gpu::writes("Counted", counters)});
    frame.compute(pipeline, bindings,
                  shaders::RouteLinksConstants{.size = pixels,
                                               .store_pixels = store.pixels(),
                                               .texels = table.texels,
                                               .first_pair = chunk.first_pair,
                                               .pairs = chunk.pairs,
                                               .first_job = first_job,
                                               .lamps = lamps,
                                               .lamps_alike = table.records.lamps().alike(),
                                               .half_pairs = table.pairs / 2},
                  groups, 1);
  };
  const auto relinks = [&](const LinkTable::Chunk& chunk, std::initializer_list<gpu::Binding> more) {
    std::vector bindings = {gpu::reads("Layers", store.layers), gpu::reads("Filled", store.filled),
                            gpu::writes("Table", chunk.links), gpu::reads("Lamps", to.direct.lamps()),
                            gpu::writes("Direct", to.direct.sums())};
    bindings.insert(bindings.end(), more);
    return bindings;
  };
  // Jobs stand in the order of their pairs, and so of the table's chunks.
  std::vector<const LinkTable::Chunk*> touched;
  auto first = batch.jobs.begin();
  for (const auto& chunk : to.chunks) {
    const auto end = std::find_if(first, batch.jobs.end(), [&](const shaders::RouteJob& job) {
      return static_cast<std::uint32_t>(batch.regions[job.region].store.z) >= chunk.first_pair + chunk.pairs;
    });
    if (first == end) continue;
    look(route_, chunk,
         relinks(chunk,
                 {gpu::reads("Jobs", jobs_), gpu::reads("Tiles", tiles_), gpu::writes("Doubts", doubts_)}),
         static_cast<std::uint32_t>(first - batch.jobs.begin()), static_cast<std::uint32_t>(end - first));
    touched.push_back(&chunk);
    first = end;
  }
  look(route_doubts_, to.chunks.front(),
       {gpu::reads("Doubts", doubts_), gpu::fetches("walls", geometry.walls), gpu::writes("Rest", rest_)}, 0,
       many_groups);
  for (const auto* chunk : touched)
    look(route_rest_, *chunk,
         relinks(*chunk,
                 {gpu::reads("Rest", rest_), gpu::reads("position", map.position),
                  gpu::reads("WallsFirst", geometry.walls_first), gpu::fetches("walls", geometry.walls)}),
         0, many_groups);
}

}  // namespace lichtveld::lightfield
