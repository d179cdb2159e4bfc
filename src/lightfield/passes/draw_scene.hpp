// The scene's triangles as emit_radiance and emit_links see them: one-sided surfaces by one pipeline,
// double-sided ones by another.
#pragma once

#include <cstddef>

#include "passes/light_map.hpp"

namespace lichtveld::lightfield {

// What a pipeline of either kind starts from.
inline gpu::GraphicsState scene_state() {
  return {.vertex_stride = sizeof(scene::Vertex),
          .attributes = {{0, vk::Format::eR32G32B32Sfloat, offsetof(scene::Vertex, position)},
                         {2, vk::Format::eR32G32Sfloat, offsetof(scene::Vertex, atlas)},
                         {4, vk::Format::eR32Uint, offsetof(scene::Vertex, body)}},
          // A surface that faces the direction of travel is seen from its front; with up pointing down the
          // raster, its counter-clockwise triangles turn clockwise.
          .front = vk::FrontFace::eClockwise};
}

// `pipelines`: of one-sided surfaces, of double-sided ones.
template <typename Constants>
void draw_scene(gpu::Draw& draw, const std::vector<gpu::GraphicsPipeline>& pipelines, const Geometry& geometry,
                const std::vector<gpu::Binding>& bindings, const Constants& constants,
                std::uint32_t instances = 1, std::uint32_t first_instance = 0) {
  const auto one_sided = geometry.scene.one_sided_indices;
  const auto all = static_cast<std::uint32_t>(geometry.scene.indices.size());
  draw.geometry(geometry.vertices, geometry.indices);
  draw.bind(pipelines[0], bindings);
  draw.push(constants);
  draw.indexed(0, one_sided, instances, first_instance);
  if (one_sided == all) return;
  draw.bind(pipelines[1], bindings);
  draw.push(constants);
  draw.indexed(one_sided, all - one_sided, instances, first_instance);
}

}  // namespace lichtveld::lightfield
