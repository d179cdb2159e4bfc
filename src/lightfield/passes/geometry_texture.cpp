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
                            {2, vk::Format::eR32G32Sfloat, offsetof(scene::Vertex, atlas)},
                            {3, vk::Format::eR32G32Sfloat, offsetof(scene::Vertex, colour)},
                            {5, vk::Format::eR16G16B16A16Unorm, offsetof(scene::Vertex, tint)}},
             .colours = std::vector(5, rgba32f)}),
      walls_(device, "geometry_texture", shaders::geometry_texture_walls_comp),
      gutter_(device, "geometry_texture", shaders::geometry_texture_gutter_comp) {}

void GeometryTexture::record(gpu::Frame& frame, const Geometry& geometry, const LightMap& map,
                             const Moves& moves) const {
  const auto cleared = moves.all ? std::optional(vk::ClearValue{}) : std::nullopt;
  gpu::Target target{.extent = map.position.extent()};
  for (const auto* image : {&map.position, &map.normal, &map.face_normal, &map.albedo, &map.emission})
    target.colours.push_back({image, cleared});
  const auto texture_of = [&](const scene::Material& material) {
    const auto& image = material.texture < 0 ? geometry.textures.back()
                                             : geometry.textures[static_cast<std::size_t>(material.texture)];
    return gpu::sampled("base_colour", image, geometry.sampler(material));
  };
  std::vector<gpu::Binding> textures;  // whatever sampler each material has for them
  for (const auto& texture : geometry.textures)
    textures.push_back(gpu::sampled("base_colour", texture, geometry.sampler({})));
  frame.render(draw_.name(), target, textures, {&geometry.vertices, &geometry.indices}, [&](gpu::Draw& draw) {
    const auto offsets = geometry.offsets.as<glm::vec4>();
    draw.geometry(geometry.vertices, geometry.indices);
    for (const auto& surface : geometry.scene.surfaces) {
      if (!moves.has(surface.body)) continue;
      const auto& material = geometry.scene.materials[surface.material];
      draw.bind(draw_, {texture_of(material)});
      draw.push(shaders::GeometryConstants{.offset = offsets[surface.body],
                                           .base_colour = glm::vec4(material.base_colour, 1),
                                           .emission = glm::vec4(material.emission, 1),
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
