#include "passes/geometry_texture.hpp"

#include <cstddef>
#include <optional>

#include "shaders/geometry_texture.frag.h"
#include "shaders/geometry_texture.vert.h"
#include "shaders/geometry_texture_gutter.comp.h"
#include "shaders/geometry_texture_walls.comp.h"
#include "shared.h"

namespace lichtveld::lightfield {

namespace {
constexpr auto rgb32f = vk::Format::eR32G32B32Sfloat;
constexpr auto rgba32f = vk::Format::eR32G32B32A32Sfloat;
}  // namespace

GeometryTexture::GeometryTexture(const gpu::Device& device)
    : draw_(device, "geometry_texture", shaders::geometry_texture_vert, shaders::geometry_texture_frag,
            {.vertex_stride = sizeof(scene::Vertex),
             .attributes = {{0, rgb32f, offsetof(scene::Vertex, position)},
                            {1, rgb32f, offsetof(scene::Vertex, normal)},
                            {2, vk::Format::eR32G32Sfloat, offsetof(scene::Vertex, atlas)}},
             .colours = std::vector(3, rgba32f)}),
      walls_(device, "geometry_texture", shaders::geometry_texture_walls_comp),
      gutter_(device, "geometry_texture", shaders::geometry_texture_gutter_comp) {}

void GeometryTexture::record(gpu::Frame& frame, const Geometry& geometry, const LightMap& map,
                             const Moves& moves) const {
  const auto cleared = moves.all ? std::optional(vk::ClearValue{}) : std::nullopt;
  gpu::Target target{.extent = map.position.extent()};
  for (const auto* image : {&map.position, &map.normal, &map.face_normal})
    target.colours.push_back({image, cleared});
  frame.render(draw_.name(), target, {}, {&geometry.vertices, &geometry.indices}, [&](gpu::Draw& draw) {
    const auto offsets = geometry.offsets.as<glm::vec4>();
    draw.geometry(geometry.vertices, geometry.indices);
    draw.bind(draw_);
    for (const auto& surface : geometry.scene.surfaces) {
      if (!moves.has(surface.body)) continue;
      draw.push(shaders::GeometryConstants{.offset = offsets[surface.body],
                                           .first_triangle = surface.first_index / 3});
      draw.indexed(surface.first_index, surface.index_count);
    }
  });
}

void GeometryTexture::find_walls(gpu::Frame& frame, const Geometry& geometry, const LightMap& map) const {
  frame.compute(walls_,
                {gpu::reads("position", map.position), gpu::reads("face_normal", map.face_normal),
                 gpu::reads("WallsFirst", geometry.walls_first), gpu::fetches("walls", geometry.walls),
                 gpu::writes("near_walls", map.near_walls)},
                map.workgroups, map.workgroups);
}

void GeometryTexture::find_shown(gpu::Frame& frame, const LightMap& map) const {
  frame.compute(
      gutter_,
      {gpu::reads("position", map.position), gpu::reads("face_normal", map.face_normal),
       gpu::reads("cover", map.cover), gpu::reads("source", map.source), gpu::writes("shown", map.shown)},
      map.workgroups, map.workgroups);
}

}  // namespace lichtveld::lightfield
