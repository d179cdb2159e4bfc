#include "passes/light_map.hpp"

#include "lichtveld/scene/walls.hpp"
#include "shared.h"

namespace lichtveld::lightfield {

namespace {

using Usage = vk::ImageUsageFlagBits;

// Pixels from a texel whose walls matter: a texel looks at centres up to one pixel away, which a flat direction
// draws out along the texel's plane; what lies beyond 8 has a cosine under 0.13 and 2 % of the light.
constexpr float wall_reach = 8;

constexpr auto rgba32f = vk::Format::eR32G32B32A32Sfloat;

// The atlas texel that each texel sends the light of.
std::vector<std::uint32_t> atlas_sources(const TexelRecords& records) {
  std::vector<std::uint32_t> sources;
  sources.reserve(records.source().size());
  for (const auto record : records.source())
    sources.push_back(record == no_record ? shaders::NO_TEXEL : records[record].atlas);
  return sources;
}

}  // namespace

gpu::Image atlas_image(const gpu::Device& device, const char* name, std::uint32_t size, vk::Format format,
                       vk::ImageUsageFlags usage) {
  return {device,
          std::string("lightfield/") + name,
          {.width = size, .height = size},
          format,
          usage | Usage::eStorage | Usage::eTransferSrc | Usage::eTransferDst};
}

LightMap::LightMap(const gpu::Device& device, const TexelRecords& records)
    : size(records.size()),
      workgroups((size + shaders::SIDE - 1) / shaders::SIDE),
      position(atlas_image(device, "position", size, rgba32f, Usage::eColorAttachment)),
      normal(atlas_image(device, "normal", size, rgba32f, Usage::eColorAttachment)),
      face_normal(atlas_image(device, "face_normal", size, rgba32f, Usage::eColorAttachment)),
      near_walls(atlas_image(device, "near_walls", size, vk::Format::eR32G32B32A32Uint)),
      albedo(atlas_image(device, "albedo", size, rgba32f)),
      emission(atlas_image(device, "emission", size, rgba32f)),
      source(atlas_image(device, "source", size, vk::Format::eR32Uint)),
      shown(atlas_image(device, "shown", size, vk::Format::eR32Uint)),
      cover(atlas_image(device, "cover", size, vk::Format::eR32Sfloat)),
      total_irradiance(atlas_image(device, "total_irradiance", size, rgba32f)),
      half_difference(atlas_image(device, "half_difference", size, rgba32f)),
      radiance(atlas_image(device, "radiance", size, rgba32f, Usage::eSampled)),
      presented(atlas_image(device, "presented", size, vk::Format::eR8G8B8A8Unorm)) {
  gpu::fill<std::uint32_t>(device, source, atlas_sources(records));
  std::vector<glm::vec4> reflected(std::size_t{size} * size, glm::vec4(0));
  for (const auto& record : records.all()) reflected[record.atlas] = glm::vec4(record.albedo, 1);
  gpu::fill<glm::vec4>(device, albedo, reflected);
}

void put_emission(const gpu::Device& device, const LightMap& map, const scene::Scene& scene,
                  const TexelRecords& records, const scene::Scales& scales) {
  std::vector<glm::vec4> emission(std::size_t{map.size} * map.size, glm::vec4(0));
  for (const auto& record : records.all())
    emission[record.atlas] = glm::vec4(scales[scene.surfaces[record.surface].light] * record.emission, 1);
  gpu::fill<glm::vec4>(device, map.emission, emission);
}

void check_on(const gpu::Device& device, const Settings& settings) {
  const auto largest = std::max(settings.size, settings.raster());
  if (largest > device.summary().max_image_size)
    throw std::invalid_argument("a size of " + std::to_string(largest) +
                                " texels or pixels: " + device.summary().name + " can do " +
                                std::to_string(device.summary().max_image_size) + " at most");
}

Geometry::Geometry(const gpu::Device& device, const scene::Scene& scene)
    : scene(scene),
      sphere(scene::bounding_sphere(scene)),
      vertices(gpu::upload<scene::Vertex>(device, "scene/vertices", scene.vertices,
                                          vk::BufferUsageFlagBits::eVertexBuffer)),
      indices(gpu::upload<std::uint32_t>(device, "scene/indices", scene.indices,
                                         vk::BufferUsageFlagBits::eIndexBuffer)),
      offsets(device, "scene/offsets", scene.bodies.size() * sizeof(glm::vec4),
              vk::BufferUsageFlagBits::eStorageBuffer, gpu::Memory::host),
      walls_first(device, "scene/walls_first", sizeof(std::uint32_t), vk::BufferUsageFlagBits::eStorageBuffer,
                  gpu::Memory::host),
      walls(device, "scene/walls", sizeof(glm::vec4), vk::BufferUsageFlagBits::eStorageBuffer,
            gpu::Memory::host, rgba32f),
      device_(device) {}

void Geometry::place(const scene::Offsets& to) {
  sphere = scene::bounding_sphere(scene, to);
  const auto places = offsets.as<glm::vec4>();
  for (std::size_t body = 0; body < to.size(); ++body) places[body] = glm::vec4(to[body], 0);
}

void Geometry::find_walls(const scene::Offsets& at, std::uint32_t pixels) {
  const gpu::TimeLedger::Stage stage(device_.times(), "find_walls");
  const float pixel = 2 * sphere.radius / static_cast<float>(pixels);
  const auto found = scene::find_walls(scene, at, shaders::CONTACT * pixel, wall_reach * pixel);
  std::vector<glm::vec4> ends;
  for (const auto& line : found.lines) {
    ends.emplace_back(line.a, line.rises ? 1 : 0);
    ends.emplace_back(line.b, 0);
  }
  gpu::put<std::uint32_t>(device_, walls_first, found.first);
  gpu::put<glm::vec4>(device_, walls, ends);
}

}  // namespace lichtveld::lightfield
