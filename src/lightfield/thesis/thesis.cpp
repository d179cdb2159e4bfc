#include "lichtveld/lightfield/thesis.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <bit>

#include "core/convergence.hpp"
#include "core/psf_view.hpp"
#include "passes/brdf.hpp"
#include "passes/geometry_texture.hpp"
#include "passes/tone_map.hpp"
#include "thesis/blend.hpp"
#include "thesis/emit_radiance.hpp"
#include "thesis/stencil_routing.hpp"

namespace lichtveld::lightfield {

namespace {

// PSFs a submission: bounds its queries and how long a GPU is held at a stretch.
constexpr std::size_t psfs_a_frame = 128;

// The sort networks want a power of two, and every sample of a routed pass is used.
std::uint32_t capacity_for(std::uint32_t layers, const Settings& settings, const gpu::Device& device) {
  const auto capacity = std::bit_ceil(layers);
  return settings.abuffer == ABuffer::stencil ? std::max(capacity, device.summary().samples) : capacity;
}

// Everything that depends on how many layers the A-buffer holds.
struct Layered {
  Layered(const gpu::Device& device, const Settings& settings, std::uint32_t capacity)
      : store(device, settings, capacity),
        emit(device, store),
        route(device, store, settings.sort),
        show(device, store) {}
  LayerStore store;
  EmitRadiance emit;
  StencilRouting route;
  ShowLayer show;
};

}  // namespace

struct Thesis::Parts {
  Parts(const gpu::Device& device, const scene::Scene& scene, const Settings& settings)
      : device(device),
        settings(settings),
        psfs(directions(settings.psf, settings.weights, settings.seed)),
        geometry(device, scene),
        map(device, settings.size),
        layered(std::make_unique<Layered>(device, settings, capacity_for(settings.layers, settings, device))),
        geometry_texture(device),
        blend(device),
        brdf(device),
        tone_map(device),
        counters(device, "lightfield/counters", sizeof(shaders::Counters),
                 vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst,
                 gpu::Memory::host) {}

  const gpu::Device& device;
  const Settings settings;
  const std::vector<Direction> psfs;
  gpu::PassTimes times;
  Geometry geometry;
  LightMap map;
  std::unique_ptr<Layered> layered;
  GeometryTexture geometry_texture;
  Blend blend;
  Brdf brdf;
  ToneMap tone_map;
  gpu::Buffer counters;

  shaders::PsfView view(std::size_t psf) const {
    return psf_view(psfs[psf], geometry.sphere, layered->store.size);
  }
  void begin(const std::vector<glm::vec3>& offsets);
  void render_bounce(bool count, Solution& solution, const StageObserver& observer, std::uint32_t observed);
  void render_psfs(std::size_t first, std::size_t end, bool count, Solution& solution);
  void clear_bounce(gpu::Frame& frame);
  void end_bounce();
  void present();
  bool widen(const Solution& solution);
  bool done(const Solution& solution) const;
  void show_stages(const StageObserver& observer);
  void show_result(const StageObserver& observer);
};

Thesis::Thesis(const gpu::Device& device, const scene::Scene& scene, const Settings& settings) {
  check_on(device, settings);
  parts_ = std::make_unique<Parts>(device, scene, settings);
}

Thesis::~Thesis() = default;

// Algorithm 1.
Solution Thesis::solve(const std::vector<glm::vec3>& offsets, const StageObserver& observer,
                       std::uint32_t observed) {
  Parts& parts = *parts_;
  Solution solution;
  parts.begin(offsets);  // geometry_texture, and L = Le
  Convergence convergence(parts.device, parts.map);
  solution.texels_valid = convergence.texels_valid();
  while (!parts.done(solution)) {
    const bool first = solution.bounces == 0;
    parts.render_bounce(first, solution, observer,
                        observed);                 // for each PSF: emit_radiance, stencil_routing, blend
    if (first && parts.widen(solution)) continue;  // layers would have been lost: again, with more
    parts.end_bounce();                            // blend into the total; brdf
    ++solution.bounces;
    solution.residual = convergence.measure(parts.device, parts.map);
  }
  solution.error_estimate = split_half_error(parts.device, parts.map);
  parts.present();  // tone_map
  if (observer) parts.show_result(observer);
  return solution;
}

std::vector<glm::vec4> Thesis::irradiance() {
  return gpu::download<glm::vec4>(parts_->device, parts_->map.total_irradiance);
}

std::vector<std::uint8_t> Thesis::presented() {
  return download_presented(parts_->device, parts_->map);
}

const gpu::PassTimes& Thesis::times() const {
  return parts_->times;
}

bool Thesis::Parts::done(const Solution& solution) const {
  if (settings.bounces) return solution.bounces >= *settings.bounces;
  if (solution.bounces < most_bounces) return solution.bounces > 0 && solution.residual < converged;
  warn_of_no_bound(solution);
  return true;
}

void Thesis::Parts::begin(const std::vector<glm::vec3>& offsets) {
  geometry.place(offsets, settings.raster());
  gpu::Frame frame(device, times);
  frame.clear("blend", map.total_irradiance, {});
  clear_bounce(frame);
  geometry_texture.record(frame, geometry, map);
  geometry_texture.find_sources(frame, map);
  brdf.record(frame, map);
  frame.submit_and_wait();
}

void Thesis::Parts::render_bounce(bool count, Solution& solution, const StageObserver& observer,
                                  std::uint32_t observed) {
  if (count) solution.overflow_pixels = solution.rays = solution.misses = solution.rays_unknown = 0;
  const bool observing = count && observer && observed < psfs.size();
  for (std::size_t first = 0; first < psfs.size();) {
    std::size_t end = std::min(first + psfs_a_frame, psfs.size());
    if (observing && first <= observed) end = std::min<std::size_t>(end, observed + 1);
    render_psfs(first, end, count, solution);
    if (observing && end == observed + 1) show_stages(observer);
    first = end;
  }
}

void Thesis::Parts::render_psfs(std::size_t first, std::size_t end, bool count, Solution& solution) {
  auto& counted = counters.as<shaders::Counters>().front();
  counted = {};
  counted.layers_max = solution.depth_layers_max;
  gpu::Frame frame(device, times);
  for (std::size_t psf = first; psf < end; ++psf) {
    layered->emit.record(frame, view(psf), geometry, map, layered->store, settings.layers, count, counters);
    layered->route.record(frame, view(psf), layered->store, geometry, map, count, counters);
    blend.psf_into_bounce(frame, map, psfs[psf].half);
  }
  frame.to_host(counters);
  frame.submit_and_wait();
  solution.rays += counted.rays;
  solution.misses += counted.misses;
  solution.rays_unknown += counted.unknown;
  solution.overflow_pixels += counted.overflow_pixels;
  solution.depth_layers_max = counted.layers_max;
}

// Makes room for all the layers there are. False if there was enough.
bool Thesis::Parts::widen(const Solution& solution) {
  const auto needed = solution.depth_layers_max;
  if (needed <= layered->store.capacity) return false;
  if (needed > most_layers)
    throw std::runtime_error("a PSF pixel has " + std::to_string(needed) + " layers, more than the " +
                             std::to_string(most_layers) +
                             " that can be kept; try fewer surfaces behind each other");
  spdlog::warn("{} PSF pixels have more than {} layers, up to {}: room is made for all of them",
               solution.overflow_pixels, settings.layers, needed);
  layered.reset();  // first, so that both need not fit
  layered = std::make_unique<Layered>(device, settings, capacity_for(needed, settings, device));
  gpu::Frame frame(device, times);
  clear_bounce(frame);
  frame.submit_and_wait();
  return true;
}

void Thesis::Parts::clear_bounce(gpu::Frame& frame) {
  for (const auto& half : map.bounce_irradiance) frame.clear("blend", half, {});
  frame.clear("stencil_routing", map.cover, {});
}

void Thesis::Parts::end_bounce() {
  gpu::Frame frame(device, times);
  blend.bounce_into_total(frame, map);
  brdf.record(frame, map);
  frame.submit_and_wait();
}

void Thesis::Parts::present() {
  gpu::Frame frame(device, times);
  geometry_texture.find_shown(frame, map);
  tone_map.record(frame, map);
  frame.submit_and_wait();
}

void Thesis::Parts::show_stages(const StageObserver& observer) {
  for (std::uint32_t layer = 0; layer < layered->store.capacity; ++layer) {
    const gpu::Image shown(device, "lightfield/shown_layer",
                           {.width = layered->store.size, .height = layered->store.size},
                           vk::Format::eR32G32B32A32Sfloat,
                           vk::ImageUsageFlagBits::eStorage | vk::ImageUsageFlagBits::eTransferSrc);
    gpu::Frame frame(device, times);
    layered->show.record(frame, layered->store, layer, shown);
    frame.submit_and_wait();
    observer("emit_radiance.layer" + std::to_string(layer), shown);
  }
  observer("stencil_routing.psf_irradiance", map.psf_irradiance);
}

void Thesis::Parts::show_result(const StageObserver& observer) {
  observer("geometry_texture.position", map.position);
  observer("geometry_texture.normal", map.normal);
  observer("geometry_texture.albedo", map.albedo);
  observer("geometry_texture.emission", map.emission);
  observer("blend.total_irradiance", map.total_irradiance);
  observer("brdf.radiance", map.radiance);
}

}  // namespace lichtveld::lightfield
