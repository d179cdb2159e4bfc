#include "thesis/emit_radiance.hpp"

#include <algorithm>
#include <array>

#include "passes/draw_scene.hpp"
#include "shaders/emit_radiance.vert.h"
#include "shaders/emit_radiance_count.comp.h"
#include "shaders/emit_radiance_list.frag.h"
#include "shaders/emit_radiance_stencil.frag.h"
#include "shaders/full_screen.vert.h"

namespace lichtveld::lightfield {

namespace {

constexpr auto layer_format = vk::Format::eR32G32B32A32Sfloat;
constexpr auto stencil_format = vk::Format::eS8Uint;

gpu::GraphicsState emission_state(const LayerStore& store, bool double_sided) {
  auto state = scene_state();
  state.cull = double_sided ? vk::CullModeFlagBits::eNone : vk::CullModeFlagBits::eBack;
  if (store.routed) {
    state.colours = {layer_format};
    state.stencil_format = stencil_format;
    state.samples = store.samples;
    // Every fragment takes one off every sample it covers, whether it was written or not. Wrapping keeps the
    // count.
    state.stencil = {.failOp = vk::StencilOp::eDecrementAndWrap,
                     .passOp = vk::StencilOp::eDecrementAndWrap,
                     .depthFailOp = vk::StencilOp::eDecrementAndWrap,
                     .compareOp = vk::CompareOp::eEqual,
                     .compareMask = 0xff,
                     .writeMask = 0xff};
  }
  return state;
}

gpu::GraphicsState set_stencil_state(const LayerStore& store, std::uint32_t sample) {
  return {.colours = {layer_format},
          .stencil_format = stencil_format,
          .stencil = {.passOp = vk::StencilOp::eReplace,
                      .compareOp = vk::CompareOp::eAlways,
                      .compareMask = 0xff,
                      .writeMask = 0xff},
          .samples = store.samples,
          .sample_mask = 1u << sample};
}

}  // namespace

LayerStore::LayerStore(const gpu::Device& device, const Settings& settings, std::uint32_t capacity)
    : size(settings.raster()),
      capacity(capacity),
      samples(std::min(capacity, device.summary().samples)),
      fetch(device.handle(), vk::SamplerCreateInfo{}) {
  device.name(fetch, "lightfield/fetch");
  if (settings.thesis.abuffer == ABuffer::list) {
    const auto pixels = vk::DeviceSize{size} * size;
    const auto usage = vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst;
    const auto bytes = pixels * capacity * sizeof(glm::vec4);
    if (bytes > device.summary().max_storage_buffer)
      throw std::runtime_error("an A-buffer of " + std::to_string(capacity) + " layers at " +
                               std::to_string(size) + " pixels a side takes " + std::to_string(bytes >> 20) +
                               " MiB, more than the device's " +
                               std::to_string(device.summary().max_storage_buffer >> 20) +
                               " MiB for one buffer; try a smaller --psf-size or --size, or --abuffer stencil");
    layers = std::make_unique<gpu::Buffer>(device, "lightfield/layers", bytes, usage);
    filled = std::make_unique<gpu::Buffer>(device, "lightfield/layers_filled", pixels * sizeof(std::uint32_t),
                                           usage);
  } else {
    const gpu::ImageShape shape{
        .width = size, .height = size, .layers = capacity / samples, .samples = samples, .array = true};
    routed = std::make_unique<gpu::Image>(
        device, "lightfield/layers", shape, layer_format,
        vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eSampled);
    stencil = std::make_unique<gpu::Image>(
        device, "lightfield/layers_stencil", gpu::ImageShape{.width = size, .height = size, .samples = samples},
        stencil_format, vk::ImageUsageFlagBits::eDepthStencilAttachment | vk::ImageUsageFlagBits::eSampled);
  }
}

std::vector<gpu::Binding> LayerStore::bindings() const {
  if (routed) return {gpu::sampled("abuffer", *routed, fetch)};
  return {gpu::reads("Layers", *layers), gpu::reads("Filled", *filled)};
}

EmitRadiance::EmitRadiance(const gpu::Device& device, const LayerStore& store)
    : bilinear_(device.handle(), vk::SamplerCreateInfo{.magFilter = vk::Filter::eLinear,
                                                       .minFilter = vk::Filter::eLinear,
                                                       .addressModeU = vk::SamplerAddressMode::eClampToEdge,
                                                       .addressModeV = vk::SamplerAddressMode::eClampToEdge}) {
  device.name(bilinear_, "lightfield/bilinear");
  const std::string name = "emit_radiance";
  if (store.routed) {
    for (std::uint32_t sample = 0; sample < store.samples; ++sample)
      set_stencil_.emplace_back(device, name, shaders::full_screen_vert, std::nullopt,
                                set_stencil_state(store, sample));
    count_.emplace_back(device, name, shaders::emit_radiance_count_comp, gpu::Specialisation{store.samples});
  }
  for (const bool double_sided : {false, true})
    draw_.emplace_back(device, name, shaders::emit_radiance_vert,
                       store.routed ? shaders::emit_radiance_stencil_frag : shaders::emit_radiance_list_frag,
                       emission_state(store, double_sided));
}

void EmitRadiance::record(gpu::Frame& frame, const shaders::PsfView& view, const Geometry& geometry,
                          const LightMap& map, const LayerStore& store, std::uint32_t limit, bool count,
                          const gpu::Buffer& counters) const {
  const shaders::EmitConstants constants{
      .view = view, .size = store.size, .capacity = store.capacity, .limit = limit, .count = count ? 1u : 0u};
  if (store.routed)
    record_stencil(frame, constants, geometry, map, store, counters);
  else
    record_list(frame, constants, geometry, map, store, counters);
}

void EmitRadiance::record_stencil(gpu::Frame& frame, const shaders::EmitConstants& constants,
                                  const Geometry& geometry, const LightMap& map, const LayerStore& store,
                                  const gpu::Buffer& counters) const {
  const std::vector bindings = {gpu::reads("Offsets", geometry.offsets),
                                gpu::sampled("radiance", map.radiance, bilinear_)};
  const vk::ClearValue no_layer(vk::ClearColorValue(std::array{0.0f, 0.0f, 0.0f, shaders::NO_LAYER}));
  const vk::ClearValue zero{vk::ClearDepthStencilValue{}};
  const std::uint32_t routed_passes = store.capacity / store.samples;
  // The last first, so that the stencil of routed pass 0 is there to be counted.
  for (std::uint32_t routed = routed_passes; routed-- > 0;) {
    const gpu::Target target{.extent = store.routed->extent(),
                             .colours = {{store.routed.get(), no_layer, routed}},
                             .stencil = gpu::Attachment{store.stencil.get(), zero}};
    frame.render("emit_radiance", target, bindings, {&geometry.vertices, &geometry.indices},
                 [&](gpu::Draw& draw) {
                   for (std::uint32_t sample = 0; sample < store.samples; ++sample) {
                     draw.bind(set_stencil_[sample]);
                     draw.stencil_reference(routed * store.samples + sample + 1);
                     draw.full_screen_triangle();
                   }
                   draw.stencil_reference(1);
                   draw_scene(draw, draw_, geometry, bindings, constants);
                 });
  }
  if (constants.count != 0) {
    const auto groups = (store.size + shaders::SIDE - 1) / shaders::SIDE;
    frame.compute(count_.front(),
                  {gpu::sampled("stencil", *store.stencil, store.fetch), gpu::writes("Counted", counters)},
                  constants, groups, groups);
  }
}

void EmitRadiance::record_list(gpu::Frame& frame, const shaders::EmitConstants& constants,
                               const Geometry& geometry, const LightMap& map, const LayerStore& store,
                               const gpu::Buffer& counters) const {
  frame.clear("emit_radiance", *store.filled);
  const std::vector bindings = {gpu::reads("Offsets", geometry.offsets),
                                gpu::sampled("radiance", map.radiance, bilinear_),
                                gpu::writes("Filled", *store.filled), gpu::writes("Layers", *store.layers),
                                gpu::writes("Counted", counters)};
  const gpu::Target target{.extent = {store.size, store.size}};
  frame.render("emit_radiance", target, bindings, {&geometry.vertices, &geometry.indices},
               [&](gpu::Draw& draw) { draw_scene(draw, draw_, geometry, bindings, constants); });
}

}  // namespace lichtveld::lightfield
