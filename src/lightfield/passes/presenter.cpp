#include "lichtveld/lightfield/presenter.hpp"

#include "passes/brdf.hpp"
#include "passes/geometry_texture.hpp"
#include "passes/tone_map.hpp"

namespace lichtveld::lightfield {

Shown present(const gpu::Device& device, const scene::Scene& scene, const scene::Offsets& offsets,
              const TexelView& irradiance) {
  const TexelRecords records(scene, irradiance.width());
  Geometry geometry(device, scene);
  const LightMap map(device, records);
  const GeometryTexture geometry_texture(device);
  const Brdf brdf(device);
  const ToneMap tone_map(device);
  irradiance.copy_to(device, map.total_irradiance);
  geometry.place(offsets, map.size);
  gpu::Frame frame(device);
  frame.clear("present", map.cover, {});
  geometry_texture.record(frame, geometry, map, {});
  geometry_texture.find_shown(frame, map);
  brdf.record(frame, map);
  tone_map.record(frame, map);
  frame.submit_and_wait();
  return download_presented(device, map);
}

}  // namespace lichtveld::lightfield
