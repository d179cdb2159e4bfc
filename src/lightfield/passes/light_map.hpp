// The textures in atlas space that the passes hand to each other, and the scene's geometry on the device.
#pragma once

#include <vector>

#include "core/texel_records.hpp"
#include "lichtveld/gpu/transfer.hpp"
#include "lichtveld/lightfield/light_field.hpp"
#include "lichtveld/lightfield/settings.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

// All size * size, linear RGB, 32-bit float. Zero outside the charts where not said otherwise.
struct LightMap {
  // With `source` and `albedo` filled in, and nothing else.
  LightMap(const gpu::Device& device, const TexelRecords& records);

  std::uint32_t size;
  std::uint32_t workgroups;  // a side, of shaders::SIDE texels each
  gpu::Image position;       // xyz [m]; a: 1 on valid texels
  gpu::Image normal;         // xyz: unit shading normal
  gpu::Image face_normal;    // xyz: unit normal of the triangle; a: the triangle's number
  gpu::Image near_walls;  // uint: the two nearest walls on its plane; distances of the first and of the third,
                          // as bits [m]
  gpu::Image albedo;      // rgb: 0..1
  gpu::Image emission;    // rgb: Le [W m^-2 sr^-1]
  gpu::Image source;      // uint: the texel whose light this one sends: TexelRecords::source()
  gpu::Image shown;       // uint: the texel whose light players see; covered texels name theirs too
  gpu::Image cover;       // weights [sr] of rays that start in contact with a surface, less all others
  gpu::Image total_irradiance;  // rgb: E [W m^-2]; a: 1 on valid texels
  gpu::Image half_difference;   // rgb: by how much each half of the directions differs from E [W m^-2], signed
  gpu::Image radiance;          // rgb: L [W m^-2 sr^-1], gutters too; a: 1 on charts and gutters
  gpu::Image presented;         // sRGB RGBA8: tone-mapped
};

// Writes `emission` as lights give `scales` times what the file says.
void put_emission(const gpu::Device& device, const LightMap& map, const scene::Scene& scene,
                  const TexelRecords& records, const scene::Scales& scales);

// Throws std::invalid_argument if the device cannot do images of that size.
void check_on(const gpu::Device& device, const Settings& settings);

// An image in atlas space; `usage` besides storage and transfers.
gpu::Image atlas_image(const gpu::Device& device, const char* name, std::uint32_t size, vk::Format format,
                       vk::ImageUsageFlags usage = {});

// The scene's triangles on the device, and where its bodies are.
struct Geometry {
  Geometry(const gpu::Device& device, const scene::Scene& scene);

  // Shifts body i by to[i] [m] from rest. Not while a frame is under way, as the next.
  void place(const scene::Offsets& to);
  // What stands on what there, as rasters of `pixels` a side can tell.
  void find_walls(const scene::Offsets& at, std::uint32_t pixels);

  const scene::Scene& scene;
  scene::Sphere sphere;  // around all of them at their places
  gpu::Buffer vertices, indices;
  gpu::Buffer offsets;  // vec4 a body, host-visible as the next two
  gpu::Buffer walls_first,
      walls;  // scene::Walls: of each triangle; two vec4 a line, the first's w: 1 if it rises

 private:
  const gpu::Device& device_;
};

}  // namespace lichtveld::lightfield
