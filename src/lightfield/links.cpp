#include "lichtveld/lightfield/links.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "brdf.hpp"
#include "convergence.hpp"
#include "gather.hpp"
#include "geometry_texture.hpp"
#include "route_links.hpp"
#include "tone_map.hpp"

namespace lichtveld::lightfield {

namespace {

// Bounces without progress after which the bound is as low as it gets.
constexpr std::uint32_t patience = 8;

// Radiance is packed into numbers up to 65408. Its highest is bounded by Le / (1 - albedo), but a bound that
// takes more than this many times Le is hardly reached by any scene, and would cost the dark ones their digits.
constexpr float most_gain = 1e4f;
constexpr float packing_limit = 60000;

struct Brightest {
  float emission = 0, albedo = 0;
};

Brightest brightest(const gpu::Device& device, const LightMap& map) {
  Brightest found;
  for (const auto& e : gpu::download<glm::vec4>(device, map.emission))
    found.emission = std::max({found.emission, e.r, e.g, e.b});
  for (const auto& a : gpu::download<glm::vec4>(device, map.albedo))
    found.albedo = std::max({found.albedo, a.r, a.g, a.b});
  return found;
}

float radiance_scale(const Brightest& of) {
  const float gain = of.albedo < 1 ? std::min(1 / (1 - of.albedo), most_gain) : most_gain;
  return of.emission > 0 ? packing_limit / (of.emission * gain) : 1;
}

// One pixel's list holds the layers of both directions of a pair.
std::uint32_t capacity_for(std::uint32_t layers) {
  return std::bit_ceil(2 * layers);
}

bool same(const scene::Sphere& a, const scene::Sphere& b) {
  return a.centre == b.centre && a.radius == b.radius;
}

scene::Box moved(const scene::Box& box, const glm::vec3& by) {
  return {box.min + by, box.max + by};
}

// The direction of each pair. Of either half every other one comes first, so that each of its parts spans the
// sphere.
std::vector<Direction> pair_directions(const Settings& settings) {
  const auto all = directions(settings.psf, settings.weights, settings.seed);
  const std::size_t half = all.size() / 4;
  std::vector<Direction> pairs;
  for (const std::size_t first : {std::size_t{0}, half})
    for (const std::size_t odd : {0, 1})
      for (auto index = odd; index < half; index += 2) pairs.push_back(all[first + index]);
  return pairs;
}

// Everything that depends on how many layers a pixel's list holds.
struct Layered {
  Layered(const gpu::Device& device, const Settings& settings, const LinkTable& table, std::uint32_t capacity)
      : store(device, settings, capacity), route(device, store, table) {}
  LinkStore store;
  RouteLinks route;
};

}  // namespace

struct Links::Parts {
  Parts(const gpu::Device& device, const scene::Scene& scene, const Settings& settings)
      : device(device),
        settings(settings),
        pair_directions(lightfield::pair_directions(settings)),
        geometry(device, scene),
        map(device, settings.size),
        geometry_texture(device),
        brdf(device),
        tone_map(device),
        counters(device, "lightfield/counters", sizeof(shaders::Counters),
                 vk::BufferUsageFlagBits::eStorageBuffer, gpu::Memory::host) {
    place(at_rest());
    find_sources();
    brightest_of_scene = brightest(device, map);
    table = std::make_unique<LinkTable>(device, scene, map, pairs());
    direct = std::make_unique<DirectLight>(device, *table);
    gather = std::make_unique<Gather>(device, *table, pair_directions, radiance_scale(brightest_of_scene));
    layered = std::make_unique<Layered>(device, settings, *table, capacity_for(settings.layers));
  }

  const gpu::Device& device;
  const Settings settings;
  const std::vector<Direction> pair_directions;
  gpu::PassTimes times;
  Geometry geometry;
  LightMap map;
  GeometryTexture geometry_texture;
  Brdf brdf;
  ToneMap tone_map;
  gpu::Buffer counters;
  Brightest brightest_of_scene;
  std::unique_ptr<LinkTable> table;
  std::unique_ptr<DirectLight> direct;
  std::unique_ptr<Gather> gather;
  std::unique_ptr<Layered> layered;
  std::optional<LinkTable::Chunk> again;  // links of two pairs, to compare
  std::vector<glm::vec3> offsets;         // of the bodies as they are linked; empty before the first time
  bool lit = false;                       // there is light to start from
  bool stepped = false;                   // the links have changed since the last bounce
  std::uint32_t next_part = 0;            // of the directions, to bounce over
  Solution solution;                      // of the last solve or update
  std::uint32_t checked = 0;              // pairs, since the last move

  std::uint32_t pairs() const { return settings.psf / 2; }
  std::vector<glm::vec3> at_rest() const { return std::vector(geometry.scene.bodies.size(), glm::vec3(0)); }
  void place(const std::vector<glm::vec3>& to);
  void find_sources();
  void link(const std::vector<glm::vec3>& to);
  Part whole_raster(std::uint32_t pair) const;
  std::vector<Part> whole_rasters() const;
  std::vector<Part> changed_parts(std::size_t body, const glm::vec3& from, const glm::vec3& to) const;
  void route(const std::vector<Part>& parts, const TileBoxes& tiles);
  std::vector<scene::Box> moved_boxes(const std::vector<glm::vec3>& from,
                                      const std::vector<glm::vec3>& to) const;
  void find_cover(const std::vector<std::uint32_t>& groups);
  LinkCheck check_two();
  void start();
  void bounce(Radiance radiance);
  void part_bounce();
  void converge(const std::function<bool(std::uint32_t)>& enough);
  void present();
};

Links::Links(const gpu::Device& device, const scene::Scene& scene, const Settings& settings) {
  check_on(device, settings);
  parts_ = std::make_unique<Parts>(device, scene, settings);
}

Links::~Links() = default;

Solution Links::solve(const std::vector<glm::vec3>& offsets) {
  Parts& parts = *parts_;
  parts.link(offsets);
  Solution& solution = parts.solution;
  solution.bounces = 0;
  parts.converge([](std::uint32_t) { return false; });
  if (solution.bounces == most_bounces && !parts.settings.bounces) warn_of_no_bound(solution);
  solution.error_estimate = split_half_error(parts.device, parts.map);
  parts.present();
  return solution;
}

Solution Links::update(const std::vector<glm::vec3>& offsets,
                       const std::function<bool(std::uint32_t)>& enough) {
  Parts& parts = *parts_;
  Solution& solution = parts.solution;
  solution.bounces = 0;
  if (offsets == parts.offsets && solution.settled) return solution;
  parts.link(offsets);
  parts.converge(enough);
  parts.present();
  return solution;
}

LinkCheck Links::check(std::uint32_t pairs) {
  LinkCheck all;
  for (std::uint32_t done = 0; done < pairs && parts_->checked < parts_->pairs(); done += 2) {
    const auto two = parts_->check_two();
    all.links += two.links;
    all.differing += two.differing;
    all.misses += two.misses;
    all.rays_unknown += two.rays_unknown;
  }
  return all;
}

std::vector<glm::vec4> Links::irradiance() {
  return gpu::download<glm::vec4>(parts_->device, parts_->map.total_irradiance);
}

std::vector<std::uint8_t> Links::presented() {
  return download_presented(parts_->device, parts_->map);
}

const gpu::PassTimes& Links::times() const {
  return parts_->times;
}

void Links::Parts::place(const std::vector<glm::vec3>& to) {
  geometry.place(to, settings.raster());
  gpu::Frame frame(device, times);
  if (offsets.empty()) frame.clear("route_links", map.cover, {});
  geometry_texture.record(frame, geometry, map);
  frame.submit_and_wait();
}

void Links::Parts::find_sources() {
  gpu::Frame frame(device, times);
  geometry_texture.find_sources(frame, map);
  frame.submit_and_wait();
}

// Brings the links to where the bodies are.
void Links::Parts::link(const std::vector<glm::vec3>& to) {
  if (to == offsets) return;
  solution.settled = false;
  const auto sphere_before = geometry.sphere;
  place(to);
  // All views are scaled by the scene's sphere; if that changes, so does every raster.
  const bool all = offsets.empty() || !same(geometry.sphere, sphere_before);
  if (all) {
    solution.rays = std::uint64_t{table->texels} * pairs();
    solution.misses = solution.rays_unknown = solution.overflow_pixels = 0;
    solution.texels_valid = table->texels;
  }
  const auto before = std::exchange(offsets, {});  // should this fail half-way, nothing is known
  const auto tiles = table->boxes(to);
  std::vector<std::uint32_t> groups(table->groups());
  if (all) {
    std::iota(groups.begin(), groups.end(), 0u);
    route(whole_rasters(), tiles);
  } else {
    groups = groups_beside(moved_boxes(before, to), contact(geometry.sphere, settings.raster()), tiles);
    // One after the other: where their ways cross, the same links change for each.
    for (std::size_t body = 1; body < to.size(); ++body)
      if (to[body] != before[body]) route(changed_parts(body, before[body], to[body]), tiles);
  }
  find_cover(groups);
  stepped = true;
  checked = 0;
  offsets = to;
}

Part Links::Parts::whole_raster(std::uint32_t pair) const {
  const auto pixels = settings.raster();
  return whole(psf_view(pair_directions[pair], geometry.sphere, pixels), pair, pixels);
}

std::vector<Part> Links::Parts::whole_rasters() const {
  std::vector<Part> parts;
  for (std::uint32_t pair = 0; pair < pairs(); ++pair) parts.push_back(whole_raster(pair));
  return parts;
}

// Of every pair's raster.
std::vector<Part> Links::Parts::changed_parts(std::size_t body, const glm::vec3& from,
                                              const glm::vec3& to) const {
  const auto pixels = settings.raster();
  std::vector<Part> parts;
  for (std::uint32_t pair = 0; pair < pairs(); ++pair)
    parts.push_back(changed(psf_view(pair_directions[pair], geometry.sphere, pixels), pair, pixels,
                            moved(geometry.scene.bodies[body].box, from), to - from));
  return parts;
}

// Where something lay on texels or may lie on them now: where the bodies that move were, and where they are.
std::vector<scene::Box> Links::Parts::moved_boxes(const std::vector<glm::vec3>& from,
                                                  const std::vector<glm::vec3>& to) const {
  std::vector<scene::Box> boxes;
  for (std::size_t body = 1; body < to.size(); ++body)
    if (to[body] != from[body])
      for (const auto& at : {from[body], to[body]}) boxes.push_back(moved(geometry.scene.bodies[body].box, at));
  return boxes;
}

void Links::Parts::route(const std::vector<Part>& parts, const TileBoxes& tiles) {
  const auto pixels = settings.raster();
  const auto before = solution;
  auto batches = pack(parts, layered->store.extent, tiles);
  bool placed = false;  // the texels, in this store's buffers
  for (std::size_t batch = 0; batch < batches.size();) {
    auto& counted = counters.as<shaders::Counters>().front();
    counted = {};
    counted.layers_max = solution.depth_layers_max;
    gpu::Frame frame(device, times);
    if (!placed) layered->route.read_receivers(frame, map, *table);
    placed = true;
    layered->route.record(frame, batches[batch], geometry, map, *table, {table->chunks, *direct, true},
                          layered->store, pixels, settings.layers, counters);
    frame.to_host(counters);
    frame.submit_and_wait();
    solution.overflow_pixels += counted.overflow_pixels;
    solution.depth_layers_max = counted.layers_max;
    if (counted.layers_max > layered->store.capacity) {
      if (counted.layers_max > 2 * most_layers)
        throw std::runtime_error("a pixel of a pair of directions has " + std::to_string(counted.layers_max) +
                                 " layers, more than the " + std::to_string(2 * most_layers) +
                                 " that can be kept; try fewer surfaces behind each other");
      spdlog::warn("{} pixels have more than {} layers, up to {}: room is made for all of them",
                   solution.overflow_pixels, settings.layers, counted.layers_max);
      layered.reset();  // first, so that both need not fit
      layered = std::make_unique<Layered>(device, settings, *table, std::bit_ceil(counted.layers_max));
      batches = pack(parts, layered->store.extent, tiles);
      batch = 0;
      placed = false;
      solution.overflow_pixels = before.overflow_pixels;
      solution.misses = before.misses;
      solution.rays_unknown = before.rays_unknown;
      continue;
    }
    solution.misses += counted.misses;
    solution.rays_unknown += counted.unknown;
    ++batch;
  }
}

// The next two pairs, which is as few as a word of the table holds.
LinkCheck Links::Parts::check_two() {
  const auto pixels = settings.raster(), first = checked;
  if (!again) again = table->make_chunk(device, "lightfield/links again", 0, 2);
  again->first_pair = first;
  const auto chunk = std::find_if(table->chunks.begin(), table->chunks.end(),
                                  [&](const auto& c) { return first < c.first_pair + c.pairs; });
  std::vector<Part> parts;
  for (const auto pair : {first, first + 1}) parts.push_back(whole_raster(pair));
  auto& counted = counters.as<shaders::Counters>().front();
  counted = {};
  for (const auto& batch : pack(parts, layered->store.extent, table->boxes(offsets))) {
    gpu::Frame frame(device, times);
    counted.doubts = counted.rest = 0;
    layered->route.record(frame, batch, geometry, map, *table, {{&*again, 1}, *direct, false}, layered->store,
                          pixels, settings.layers, counters);
    frame.to_host(counters);
    frame.submit_and_wait();
  }
  gpu::Frame frame(device, times);
  layered->route.compare(frame, *table, *chunk, first, *again, counters);
  frame.to_host(counters);
  frame.submit_and_wait();
  checked += 2;
  return {.links = 2 * std::uint64_t{table->texels},
          .differing = counted.differing,
          .misses = counted.misses,
          .rays_unknown = counted.unknown};
}

void Links::Parts::find_cover(const std::vector<std::uint32_t>& groups) {
  gpu::Frame frame(device, times);
  layered->route.find_cover(frame, geometry, map, *table, gather->directions(), settings.raster(), groups);
  frame.submit_and_wait();
}

void Links::Parts::start() {
  gpu::Frame frame(device, times);
  gather->start(frame, map, *table, *direct);
  frame.submit_and_wait();
  lit = true;
}

void Links::Parts::bounce(Radiance radiance) {
  gpu::Frame frame(device, times);
  gather->bounce(frame, map, *table, *direct, radiance);
  frame.submit_and_wait();
  ++solution.bounces;
  const auto change = gather->change(*table);
  solution.residual = bound_on_missing(change.most, brightest_of_scene.albedo, change.mean);
}

// What serve shows while things move: direct light as it is, and a bounce over a part of the directions, which
// leaves of the others what surfaces reflected some steps ago. It says nothing about what is missing.
void Links::Parts::part_bounce() {
  const auto parts = static_cast<std::uint32_t>(settings.step_bounces * shaders::PARTS);
  gpu::Frame frame(device, times);
  gather->bounce(frame, map, *table, *direct, settings.radiance, next_part, parts);
  frame.submit_and_wait();
  next_part = (next_part + parts) % shaders::PARTS;
  solution.residual = std::numeric_limits<double>::infinity();
  ++solution.bounces;
}

// As many bounces as are asked for; or until the bound is met, or falls no more, for rounding.
void Links::Parts::converge(const std::function<bool(std::uint32_t)>& enough) {
  if (settings.bounces) {
    start();
    while (solution.bounces < *settings.bounces) bounce(Radiance::full);
    solution.settled = true;
    return;
  }
  const bool step = std::exchange(stepped, false) && lit;
  if (!lit) start();
  const auto asked = step ? static_cast<std::uint32_t>(settings.step_bounces) : 0;
  if (step && settings.step_bounces < 1) part_bounce();
  // Packed radiance flickers in its last digits: light does not settle by it.
  if (settings.radiance == Radiance::packed)
    while (solution.bounces < asked) bounce(Radiance::packed);
  if (solution.bounces > 0 && enough(solution.bounces)) return;
  double least = std::numeric_limits<double>::infinity();
  std::uint32_t since = 0;
  do {
    bounce(Radiance::full);
    since = solution.residual < least ? 0 : since + 1;
    least = std::min(least, solution.residual);
    solution.settled = solution.residual < converged || since == patience || solution.bounces == most_bounces;
  } while (!solution.settled && (solution.bounces < asked || !enough(solution.bounces)));
}

void Links::Parts::present() {
  gpu::Frame frame(device, times);
  brdf.record(frame, map);
  geometry_texture.find_shown(frame, map);
  tone_map.record(frame, map);
  frame.submit_and_wait();
}

}  // namespace lichtveld::lightfield
