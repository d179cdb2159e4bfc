#include "thesis/stencil_routing.hpp"

#include "shaders/abuffer_layer_list.comp.h"
#include "shaders/abuffer_layer_stencil.comp.h"
#include "shaders/stencil_routing_list.comp.h"
#include "shaders/stencil_routing_stencil.comp.h"

namespace lichtveld::lightfield {

namespace {

std::vector<gpu::Kind> with_store(const LayerStore& store, std::initializer_list<gpu::Kind> more) {
  auto kinds = store.kinds();
  kinds.insert(kinds.end(), more);
  return kinds;
}

}  // namespace

StencilRouting::StencilRouting(const gpu::Device& device, const LayerStore& store, Sort sort)
    : route_(device, "stencil_routing",
             store.routed ? gpu::Spirv(stencil_routing_stencil_comp) : gpu::Spirv(stencil_routing_list_comp),
             {.kinds = with_store(
                  store, {gpu::Kind::storage_image, gpu::Kind::storage_image, gpu::Kind::storage_image,
                          gpu::Kind::storage_image, gpu::Kind::storage_image, gpu::Kind::storage_buffer,
                          gpu::Kind::texel_buffer, gpu::Kind::storage_image, gpu::Kind::storage_buffer}),
              .push_bytes = sizeof(shaders::RoutingConstants),
              .specialisation = {store.capacity, static_cast<std::uint32_t>(sort), store.samples}}) {}

void StencilRouting::record(gpu::Frame& frame, const shaders::PsfView& view, const LayerStore& store,
                            const Geometry& geometry, const LightMap& map, const BounceSums& sums, bool count,
                            const gpu::Buffer& counters) const {
  auto bindings = store.bindings();
  bindings.insert(bindings.end(),
                  {gpu::reads(map.position), gpu::reads(map.normal), gpu::reads(map.face_normal),
                   gpu::writes(sums.psf_irradiance), gpu::writes(map.cover), gpu::reads(geometry.walls_first),
                   gpu::fetches(geometry.walls), gpu::reads(map.near_walls), gpu::writes(counters)});
  frame.compute(route_, bindings,
                shaders::RoutingConstants{.view = view, .size = store.size, .count = count ? 1u : 0u},
                map.groups, map.groups);
}

ShowLayer::ShowLayer(const gpu::Device& device, const LayerStore& store)
    : show_(device, "show_layer",
            store.routed ? gpu::Spirv(abuffer_layer_stencil_comp) : gpu::Spirv(abuffer_layer_list_comp),
            {.kinds = with_store(store, {gpu::Kind::storage_image}),
             .push_bytes = sizeof(shaders::LayerConstants),
             .specialisation = {store.capacity, 0, store.samples}}) {}

void ShowLayer::record(gpu::Frame& frame, const LayerStore& store, std::uint32_t layer,
                       const gpu::Image& shown) const {
  auto bindings = store.bindings();
  bindings.push_back(gpu::writes(shown));
  const auto groups = (store.size + shaders::GROUP - 1) / shaders::GROUP;
  frame.compute(show_, bindings, shaders::LayerConstants{.size = store.size, .layer = layer}, groups, groups);
}

}  // namespace lichtveld::lightfield
