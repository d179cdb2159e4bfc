// The textures in atlas space that the passes hand to each other, and the scene's geometry on the device.
#pragma once

#include <vector>

#include "lichtveld/gpu/transfer.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

// All size * size, linear RGB, 32-bit float. Zero outside the charts where not said otherwise.
struct LightMap {
  LightMap(const gpu::Device& device, std::uint32_t size);

  std::uint32_t size;
  std::uint32_t groups;          // compute workgroups a side
  gpu::Image position;           // xyz [m]; a: 1 on valid texels
  gpu::Image normal;             // xyz: unit shading normal
  gpu::Image face_normal;        // xyz: unit normal of the triangle
  gpu::Image albedo;             // rgb: 0..1
  gpu::Image emission;           // rgb: Le [W m^-2 sr^-1]
  gpu::Image source;             // uint: the texel whose light this one shows; gutters name their nearest
  gpu::Image psf_irradiance;     // rgb: w_k L_k [W m^-2]; a: w_k [sr]; of one direction
  gpu::Image bounce_irradiance;  // their sums over the directions
  gpu::Image total_irradiance;   // rgb: E [W m^-2]; a: 1 on valid texels
  gpu::Image radiance;           // rgb: L [W m^-2 sr^-1], gutters too; a: 1 on charts and gutters
  gpu::Image presented;          // sRGB RGBA8: tone-mapped L
};

// The presented map's bytes, RGBA.
std::vector<std::uint8_t> download_presented(const gpu::Device& device, const LightMap& map);

// The scene's triangles and textures on the device, and where its bodies are.
struct Geometry {
  Geometry(const gpu::Device& device, const scene::Scene& scene);

  // Shifts body i by offsets[i] [m] from rest. Not while a frame is under way.
  void place(const std::vector<glm::vec3>& shifts);

  const scene::Scene& scene;
  gpu::Buffer vertices, indices;
  gpu::Buffer offsets;               // vec4 a body, host-visible
  std::vector<gpu::Image> textures;  // of Scene::textures, and a white one at the end
  vk::raii::Sampler sampler;         // linear, repeating: for textures
};

}  // namespace lichtveld::lightfield
