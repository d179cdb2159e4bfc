#include "links/kept_links.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "lichtveld/progress/progress.hpp"
#include "lichtveld/scene/lights.hpp"

namespace lichtveld::lightfield {

namespace {

// One pixel's list holds the layers of both directions of a pair.
std::uint32_t capacity_for(std::uint32_t layers) {
  return std::bit_ceil(2 * layers);
}

// What lies nearer to a moved body than this share of its longest side is beside it.
constexpr float beside_share = 1;

bool same(const scene::Sphere& a, const scene::Sphere& b) {
  return a.centre == b.centre && a.radius == b.radius;
}

scene::Box moved(const scene::Box& box, const glm::vec3& by) {
  return {box.min + by, box.max + by};
}

scene::Box grown(const scene::Box& box, float share) {
  const auto extent = box.max - box.min;
  const float by = share * std::max({extent.x, extent.y, extent.z});
  return {box.min - by, box.max + by};
}

// A batch's regions stand in the order of their pairs.
std::string directions_of(const RegionBatch& batch) {
  return fmt::format("pairs of directions {}..{}", batch.regions.front().store.z, batch.regions.back().store.z);
}

// What shaders fetch at once of each pair.
gpu::Buffer upload_directions(const gpu::Device& device, std::span<const Direction> pairs) {
  std::vector<glm::vec4> directions;
  for (const auto& pair : pairs) directions.emplace_back(pair.along, pair.solid_angle);
  return gpu::upload<glm::vec4>(device, "lightfield/pair_directions", directions,
                                vk::BufferUsageFlagBits::eStorageBuffer, vk::Format::eR32G32B32A32Sfloat);
}

}  // namespace

KeptLinks::KeptLinks(const gpu::Device& device, const scene::Scene& scene, const Settings& settings)
    : device_(device),
      settings_(settings),
      records_(device.times().time("texel_records", [&] { return TexelRecords(scene, settings.size); })),
      set_(settings.psf, settings.weights, settings.seed),
      geometry_(device, scene),
      map_(device, records_),
      geometry_texture_(device),
      counters_(device, "lightfield/counters", sizeof(shaders::Counters),
                vk::BufferUsageFlagBits::eStorageBuffer, gpu::Memory::host),
      directions_(upload_directions(device, set_.pairs())),
      table_(device, records_, static_cast<std::uint32_t>(set_.pairs().size()), settings.memory),
      direct_(device, scene, table_, settings.direct.value_or(Direct::exact)),
      capacity_(capacity_for(settings.layers)) {
  layered();
}

void KeptLinks::link(const scene::Offsets& to, const scene::Scales& scales, const Moves& moves,
                     Solution& solution) {
  if (moves.any()) link(to, moves, solution);
  if (moves.all || moves.dimmed) put_emission(device_, map_, geometry_.scene, records_, scales);
  direct_.light(to, scales, moves);
}

void KeptLinks::link(const scene::Offsets& to, const Moves& moves, Solution& solution) {
  const auto sphere_before = geometry_.sphere;
  gpu::Frame placing(device_, {"links", "place"});
  geometry_.place(to);
  geometry_.find_walls(to, settings_.raster());
  if (moves.all) placing.clear("route_links", map_.cover, {});
  geometry_texture_.record(placing, geometry_, map_, moves);
  geometry_texture_.find_walls(placing, geometry_, map_);
  layered().received = false;
  placing.submit();                                       // while it is drawn, the host looks up what to route
  done_ = {.linked_at = to, .direct_summed = moves.all};  // the first links of all sum it up
  const gpu::TimeLedger::Stage stage(device_.times(), "route_links");
  const auto tiles = table_.boxes(to);
  // All views are scaled by the scene's sphere; if that changes, so does every raster.
  if (moves.all || !same(geometry_.sphere, sphere_before)) {
    for (std::uint32_t group = 0; group < table_.groups(); ++group) cover_unknown_.insert(group);
    beside_ = {cover_unknown_.begin(), cover_unknown_.end()};
    solution.rays = std::uint64_t{table_.texels} * table_.pairs;
    solution.misses = solution.rays_unknown = solution.overflow_pixels = 0;
    solution.texels_valid = table_.texels;
    route(whole_patches(), tiles, solution);
  } else {
    auto boxes = moved_boxes(moves);
    cover_unknown_.merge(groups_beside(boxes, contact(geometry_.sphere, settings_.raster()), tiles));
    for (auto& box : boxes) box = grown(box, beside_share);
    const auto beside = groups_beside(boxes, 0, tiles);
    beside_ = {beside.begin(), beside.end()};
    // One after the other: where their ways cross, the same links change for each.
    for (const auto& move : moves.bodies) route(changed_patches(move), tiles, solution);
  }
  placing.wait();
}

void KeptLinks::sum_direct() {
  if (direct_.is_exact() || std::exchange(done_.direct_summed, true)) return;
  gpu::Frame frame(device_, {"links", "direct light"});
  direct_.sum(frame, map_, table_, directions_);
  frame.submit_and_wait();
}

KeptLinks::Layered& KeptLinks::layered() {
  if (!layered_) layered_ = std::make_unique<Layered>(device_, settings_, table_, capacity_);
  return *layered_;
}

Patch KeptLinks::whole_patch(std::uint32_t pair) const {
  const auto pixels = settings_.raster();
  return lightfield::whole_patch(psf_view(set_.pairs()[pair], geometry_.sphere, pixels), pair, pixels);
}

std::vector<Patch> KeptLinks::whole_patches() const {
  std::vector<Patch> patches;
  for (std::uint32_t pair = 0; pair < table_.pairs; ++pair) patches.push_back(whole_patch(pair));
  return patches;
}

// Of every pair's raster.
std::vector<Patch> KeptLinks::changed_patches(const Moves::Move& move) const {
  const auto pixels = settings_.raster();
  std::vector<Patch> patches;
  for (std::uint32_t pair = 0; pair < table_.pairs; ++pair)
    patches.push_back(changed_patch(psf_view(set_.pairs()[pair], geometry_.sphere, pixels), pair, pixels,
                                    moved(geometry_.scene.bodies[move.body].box, move.from),
                                    move.to - move.from));
  return patches;
}

// Where something lay on texels or may lie on them now: where the bodies that move were, and where they are.
std::vector<scene::Box> KeptLinks::moved_boxes(const Moves& moves) const {
  std::vector<scene::Box> boxes;
  for (const auto& move : moves.bodies)
    for (const auto& at : {move.from, move.to})
      boxes.push_back(moved(geometry_.scene.bodies[move.body].box, at));
  return boxes;
}

void KeptLinks::route(const std::vector<Patch>& patches, const TileBoxes& tiles, Solution& solution) {
  const auto pixels = settings_.raster();
  const auto before = solution;
  auto batches = pack(patches, layered().store.extent, tiles);
  progress::Work work("links", batches.size());
  for (std::size_t batch = 0; batch < batches.size();) {
    auto& counted = counters_.as<shaders::Counters>().front();
    counted = {};
    counted.layers_max = solution.depth_layers_max;
    gpu::Frame frame(device_, {"links", "find links", directions_of(batches[batch])});
    if (!std::exchange(layered().received, true)) layered().route.read_receivers(frame, map_, table_);
    layered().route.record(frame, batches[batch], geometry_, map_, table_, {table_.chunks, direct_, true},
                           layered().store, pixels, settings_.layers, counters_);
    frame.to_host(counters_);
    frame.submit_and_wait();
    solution.overflow_pixels += counted.overflow_pixels;
    solution.depth_layers_max = counted.layers_max;
    if (counted.layers_max > layered().store.capacity) {
      if (counted.layers_max > 2 * most_layers)
        throw std::runtime_error("a pixel of a pair of directions has " + std::to_string(counted.layers_max) +
                                 " layers, more than the " + std::to_string(2 * most_layers) +
                                 " that can be kept; try fewer surfaces behind each other");
      spdlog::warn("{} pixels have more than {} layers, up to {}: room is made for all of them",
                   solution.overflow_pixels, settings_.layers, counted.layers_max);
      capacity_ = std::bit_ceil(counted.layers_max);
      layered_.reset();  // first, so that both need not fit
      batches = pack(patches, layered().store.extent, tiles);
      batch = 0;
      solution.overflow_pixels = before.overflow_pixels;
      solution.misses = before.misses;
      solution.rays_unknown = before.rays_unknown;
      continue;
    }
    solution.misses += counted.misses;
    solution.rays_unknown += counted.unknown;
    ++batch;
    work.done();
  }
}

LinkCheck KeptLinks::check(std::uint32_t pairs) {
  LinkCheck all;
  for (std::uint32_t done = 0; done < pairs && done_.pairs_checked < table_.pairs; done += 2) {
    const auto two = check_two();
    all.links += two.links;
    all.differing += two.differing;
    all.misses += two.misses;
    all.rays_unknown += two.rays_unknown;
  }
  return all;
}

// The next two pairs, which is as few as a word of the table holds.
LinkCheck KeptLinks::check_two() {
  const auto pixels = settings_.raster(), first = done_.pairs_checked;
  if (!again_) again_ = table_.make_chunk(device_, "lightfield/links again", 0, 2);
  again_->first_pair = first;
  const auto chunk = std::find_if(table_.chunks.begin(), table_.chunks.end(),
                                  [&](const auto& c) { return first < c.first_pair + c.pairs; });
  std::vector<Patch> patches;
  for (const auto pair : {first, first + 1}) patches.push_back(whole_patch(pair));
  auto& counted = counters_.as<shaders::Counters>().front();
  counted = {};
  for (const auto& batch : pack(patches, layered().store.extent, table_.boxes(done_.linked_at))) {
    gpu::Frame frame(device_, {"links", "check"});
    counted.doubts = counted.rest = 0;
    layered().route.record(frame, batch, geometry_, map_, table_, {{&*again_, 1}, direct_, false},
                           layered().store, pixels, settings_.layers, counters_);
    frame.to_host(counters_);
    frame.submit_and_wait();
  }
  gpu::Frame frame(device_, {"links", "check"});
  layered().route.compare(frame, table_, *chunk, first, *again_, counters_);
  frame.to_host(counters_);
  frame.submit_and_wait();
  done_.pairs_checked += 2;
  return {.links = 2 * std::uint64_t{table_.texels},
          .differing = counted.differing,
          .misses = counted.misses,
          .rays_unknown = counted.unknown};
}

void KeptLinks::find_shown(gpu::Frame& frame) {
  if (!cover_unknown_.empty())
    layered().route.find_cover(frame, geometry_, map_, table_, directions_, settings_.raster(),
                               {cover_unknown_.begin(), cover_unknown_.end()});
  cover_unknown_.clear();
  geometry_texture_.find_shown(frame, map_);
}

}  // namespace lichtveld::lightfield
