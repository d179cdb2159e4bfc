#include "thesis/stencil_routing.hpp"

#include "shaders/abuffer_layer_list.comp.h"
#include "shaders/abuffer_layer_stencil.comp.h"
#include "shaders/stencil_routing_list.comp.h"
#include "shaders/stencil_routing_stencil.comp.h"

namespace lichtveld::lightfield {

StencilRouting::StencilRouting(const gpu::Device& device, const LayerStore& store, Sort sort)
    : route_(device, "stencil_routing",
             store.routed ? shaders::stencil_routing_stencil_comp : shaders::stencil_routing_list_comp,
             {store.capacity, static_cast<std::uint32_t>(sort), store.samples}) {}

void StencilRouting::record(gpu::Frame& frame, const shaders::PsfView& view, const LayerStore& store,
                            const Geometry& geometry, const LightMap& map, const BounceSums& sums, bool count,
                            const gpu::Buffer& counters) const {
  auto bindings = store.bindings();
  bindings.insert(bindings.end(),
                  {gpu::reads("position", map.position), gpu::reads("normal", map.normal),
                   gpu::reads("face_normal", map.face_normal),
                   gpu::writes("psf_irradiance", sums.psf_irradiance), gpu::writes("cover", map.cover),
                   gpu::reads("WallsFirst", geometry.walls_first), gpu::fetches("walls", geometry.walls),
                   gpu::reads("near_walls", map.near_walls), gpu::writes("Counted", counters)});
  frame.compute(route_, bindings,
                shaders::RoutingConstants{.view = view, .size = store.size, .count = count ? 1u : 0u},
                map.workgroups, map.workgroups);
}

ShowLayer::ShowLayer(const gpu::Device& device, const LayerStore& store)
    : show_(device, "show_layer",
            store.routed ? shaders::abuffer_layer_stencil_comp : shaders::abuffer_layer_list_comp,
            {store.capacity, 0, store.samples}) {}

void ShowLayer::record(gpu::Frame& frame, const LayerStore& store, std::uint32_t layer,
                       const gpu::Image& shown) const {
  auto bindings = store.bindings();
  bindings.push_back(gpu::writes("shown_layer", shown));
  const auto groups = (store.size + shaders::SIDE - 1) / shaders::SIDE;
  frame.compute(show_, bindings, shaders::LayerConstants{.size = store.size, .layer = layer}, groups, groups);
}

}  // namespace lichtveld::lightfield
