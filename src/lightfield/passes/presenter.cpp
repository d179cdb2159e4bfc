#include "lichtveld/lightfield/presenter.hpp"

#include <array>

#include "passes/brdf.hpp"
#include "passes/geometry_texture.hpp"
#include "passes/tone_map.hpp"

namespace lichtveld::lightfield {

std::vector<std::uint8_t> present(const gpu::Device& device, const scene::Scene& scene, std::uint32_t size,
                                  const std::vector<glm::vec3>& offsets,
                                  std::span<const glm::vec4> irradiance) {
  Geometry geometry(device, scene);
  const LightMap map(device, size);
  GeometryTexture geometry_texture(device);
  const Brdf brdf(device);
  const ToneMap tone_map(device);
  const gpu::Buffer given =
      gpu::upload(device, "lightfield/given_irradiance", irradiance, vk::BufferUsageFlagBits::eTransferSrc);
  geometry.place(offsets, size);
  gpu::PassTimes times;
  gpu::Frame frame(device, times);
  frame.clear("present", map.cover, {});
  geometry_texture.record(frame, geometry, map);
  geometry_texture.find_sources(frame, map);
  geometry_texture.find_shown(frame, map);
  frame.copy("present", given, map.total_irradiance);
  brdf.record(frame, map);
  tone_map.record(frame, map);
  frame.submit_and_wait();
  return download_presented(device, map);
}

}  // namespace lichtveld::lightfield
