#include "thesis/thesis.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <bit>

#include "core/convergence.hpp"
#include "core/psf_view.hpp"
#include "lichtveld/progress/progress.hpp"
#include "lichtveld/scene/lights.hpp"

namespace lichtveld::lightfield {

namespace {

// PSFs a submission: bounds its queries and how long a GPU is held at a stretch.
constexpr std::uint32_t psfs_a_frame = 128;

// Of the bounce that follows.
std::string bounce_label(const Solution& solution) {
  return fmt::format("bounce {}", solution.bounces + 1);
}

}  // namespace

Thesis::Layered::Layered(const gpu::Device& device, const Settings& settings, std::uint32_t capacity)
    : store(device, settings, capacity),
      emit(device, store),
      route(device, store, settings.thesis.sort),
      show(device, store) {}

Thesis::Thesis(const gpu::Device& device, const scene::Scene& scene, const Settings& settings)
    : LightField(scene, settings.direct.value_or(Direct::psf)),
      device_((check_on(device, settings), device)),
      begun_(device.times().so_far()),
      settings_(settings),
      directions_(settings.psf, settings.weights, settings.seed),
      records_(device.times().time("texel_records", [&] { return TexelRecords(scene, settings.size); })),
      geometry_(device, scene),
      map_(device, records_),
      sums_(device, settings.size),
      geometry_texture_(device),
      blend_(device),
      brdf_(device),
      tone_map_(device),
      over_(device, scene, records_),
      counters_(device, "lightfield/counters", sizeof(shaders::Counters),
                vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst,
                gpu::Memory::host) {
  if (settings.direct != Direct::exact) return;
  index_ = std::make_unique<scene::RayIndex>(scene);
  lamps_.emplace(*index_, scene, records_.all(), records_.size());
}

// Algorithm 1. Whatever is known of before, it is computed afresh.
bool Thesis::compute(Light, const Moves& moves, const Enough&, Solution& solution) {
  begin(moves);  // geometry_texture, and L = Le
  Convergence convergence(records_);
  solution = {.texels_valid = records_.count()};
  if (lamps_) {
    light_by_lamps(moves);
    end_bounce(solution);
    solution.bounces = 1;
    solution.residual = convergence.measure(irradiance());
  }
  const auto first_of_psfs = solution.bounces;
  while (!done(solution)) {
    const bool count = solution.bounces == first_of_psfs;
    render_bounce(solution, count);          // for each PSF: emit_radiance, stencil_routing, blend
    if (count && widen(solution)) continue;  // layers would have been lost: again, with more
    end_bounce(solution);                    // blend into the total; brdf
    ++solution.bounces;
    solution.residual = convergence.measure(irradiance());
  }
  if (observer_) show_result();
  return true;
}

double Thesis::error_estimate() const {
  auto half = gpu::download<glm::vec4>(device_, map_.half_difference);
  for (std::uint32_t number = 0; lamps_ && number < records_.count(); ++number)
    half[records_[number].atlas] +=
        glm::vec4(lamps_->half_difference(number, false) + lamps_->half_difference(number, true), 0);
  return split_half_error(irradiance(), half);
}

void Thesis::observe(StageObserver observer, std::uint32_t direction) {
  observer_ = std::move(observer);
  observed_ = direction;
}

// The sort networks want a power of two, and every sample of a routed pass is used.
std::uint32_t Thesis::capacity_for(std::uint32_t layers) const {
  const auto capacity = std::bit_ceil(layers);
  return settings_.thesis.abuffer == ABuffer::stencil ? std::max(capacity, device_.summary().samples)
                                                      : capacity;
}

bool Thesis::done(const Solution& solution) const {
  if (settings_.bounces) return solution.bounces >= *settings_.bounces;
  return solution.bounces >= most_bounces || (solution.bounces > 0 && solution.residual < converged);
}

void Thesis::begin(const Moves& moves) {
  if (!layered_) layered_ = std::make_unique<Layered>(device_, settings_, capacity_for(settings_.layers));
  geometry_.place(offsets());
  geometry_.find_walls(offsets(), settings_.raster());
  if (moves.all || moves.dimmed) put_emission(device_, map_, geometry_.scene, records_, scales());
  gpu::Frame frame(device_, {"thesis", "set up"});
  frame.clear("blend", map_.total_irradiance, {});
  if (moves.all) frame.clear("blend", sums_.lamp_irradiance, {});
  clear_bounce(frame);
  geometry_texture_.record(frame, geometry_, map_, moves);
  geometry_texture_.find_walls(frame, geometry_, map_);
  brdf_.record(frame, map_, !lamps_);
  frame.submit_and_wait();
}

// The bounce of lamps, which no PSF brings: into sums_.lamp_irradiance.
void Thesis::light_by_lamps(const Moves& moves) {
  const gpu::TimeLedger::Stage stage(device_.times(), "direct_light");
  lamps_->light(offsets(), scales(), moves);
  std::vector<glm::vec4> texels(std::size_t{map_.size} * map_.size, glm::vec4(0));
  for (std::uint32_t number = 0; number < records_.count(); ++number)
    texels[records_[number].atlas] = glm::vec4(lamps_->irradiance()[number], 0);
  gpu::fill<glm::vec4>(device_, sums_.lamp_irradiance, texels);
}

// `count`: what is counted, is counted in this one.
void Thesis::render_bounce(Solution& solution, bool count) {
  if (count) solution.overflow_pixels = solution.rays = solution.misses = solution.rays_unknown = 0;
  const bool observing = count && observer_ && observed_ < directions_.size();
  progress::Work work(bounce_label(solution), directions_.size());
  for (std::uint32_t first = 0; first < directions_.size();) {
    auto end = std::min(first + psfs_a_frame, directions_.size());
    if (observing && first <= observed_) end = std::min(end, observed_ + 1);
    render_psfs({first, end}, count, solution);
    if (observing && end == observed_ + 1) show_stages();
    work.done(end - first);
    first = end;
  }
}

void Thesis::render_psfs(Range range, bool count, Solution& solution) {
  auto& counted = counters_.as<shaders::Counters>().front();
  counted = {};
  counted.layers_max = solution.depth_layers_max;
  gpu::Frame frame(device_, {"thesis", bounce_label(solution),
                             fmt::format("directions {}..{}", range.first, range.end - 1)});
  for (auto psf = range.first; psf < range.end; ++psf) {
    const auto view = psf_view(directions_[psf], geometry_.sphere, layered_->store.size);
    layered_->emit.record(frame, view, geometry_, map_, layered_->store, settings_.layers, count, counters_);
    layered_->route.record(frame, view, layered_->store, geometry_, map_, sums_, count, counters_);
    blend_.psf_into_bounce(frame, sums_, directions_[psf].half, map_.workgroups);
  }
  frame.to_host(counters_);
  frame.submit_and_wait();
  solution.rays += counted.rays;
  solution.misses += counted.misses;
  solution.rays_unknown += counted.unknown;
  solution.overflow_pixels += counted.overflow_pixels;
  solution.depth_layers_max = counted.layers_max;
}

// Makes room for all the layers there are. False if there was enough.
bool Thesis::widen(const Solution& solution) {
  const auto needed = solution.depth_layers_max;
  if (needed <= layered_->store.capacity) return false;
  if (needed > most_layers)
    throw std::runtime_error("a PSF pixel has " + std::to_string(needed) + " layers, more than the " +
                             std::to_string(most_layers) +
                             " that can be kept; try fewer surfaces behind each other");
  spdlog::warn("{} PSF pixels have more than {} layers, up to {}: room is made for all of them",
               solution.overflow_pixels, settings_.layers, needed);
  layered_.reset();  // first, so that both need not fit
  layered_ = std::make_unique<Layered>(device_, settings_, capacity_for(needed));
  gpu::Frame frame(device_, {"thesis", bounce_label(solution)});
  clear_bounce(frame);
  frame.submit_and_wait();
  return true;
}

void Thesis::clear_bounce(gpu::Frame& frame) const {
  for (const auto& half : sums_.bounce_irradiance) frame.clear("blend", half, {});
  frame.clear("stencil_routing", map_.cover, {});
}

void Thesis::end_bounce(const Solution& solution) {
  gpu::Frame frame(device_, {"thesis", bounce_label(solution)});
  blend_.bounce_into_total(frame, sums_, map_);
  brdf_.record(frame, map_, !lamps_);
  frame.submit_and_wait();
}

// tone_map
Shown Thesis::shown(const Adaptation& adaptation) {
  over_.put(irradiance_view());
  gpu::Frame frame(device_, {"thesis", "present"});
  if (lamps_) brdf_.record(frame, map_);
  geometry_texture_.find_shown(frame, map_);
  tone_map_.record(frame, map_, over_, adaptation);
  frame.submit_and_wait();
  return tone_map_.shown(map_);
}

void Thesis::show_stages() {
  for (std::uint32_t layer = 0; layer < layered_->store.capacity; ++layer) {
    const gpu::Image shown(device_, "lightfield/shown_layer",
                           {.width = layered_->store.size, .height = layered_->store.size},
                           vk::Format::eR32G32B32A32Sfloat,
                           vk::ImageUsageFlagBits::eStorage | vk::ImageUsageFlagBits::eTransferSrc);
    gpu::Frame frame(device_, {"thesis", "dump"});
    layered_->show.record(frame, layered_->store, layer, shown);
    frame.submit_and_wait();
    observer_("emit_radiance.layer" + std::to_string(layer), {device_, shown});
  }
  observer_("stencil_routing.psf_irradiance", {device_, sums_.psf_irradiance});
}

void Thesis::show_result() {
  observer_("geometry_texture.position", {device_, map_.position});
  observer_("geometry_texture.normal", {device_, map_.normal});
  observer_("geometry_texture.albedo", {device_, map_.albedo});
  observer_("geometry_texture.emission", {device_, map_.emission});
  observer_("blend.total_irradiance", {device_, map_.total_irradiance});
  observer_("brdf.radiance", {device_, map_.radiance});
}

}  // namespace lichtveld::lightfield
