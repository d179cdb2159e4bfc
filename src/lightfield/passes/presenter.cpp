#include "passes/presenter.hpp"

#include "lichtveld/lightfield/presenter.hpp"
#include "lichtveld/scene/lights.hpp"

namespace lichtveld::lightfield {

Presenter::Presenter(const gpu::Device& device, const scene::Scene& scene, const TexelRecords& records)
    : device_(device),
      scene_(scene),
      records_(records),
      scales_(scene::full(scene)),
      map_(device, records),
      geometry_texture_(device),
      brdf_(device),
      tone_map_(device),
      over_(device, scene, records) {
  // Where bodies are changes nothing of what is shown here: which texels face the same way.
  Geometry geometry(device, scene);
  geometry.place(scene::Offsets(scene.bodies.size(), glm::vec3(0)));
  gpu::Frame frame(device);
  frame.clear("present", map_.cover, {});
  geometry_texture_.record(frame, geometry, map_, {});
  frame.submit_and_wait();
  put_emission(device_, map_, scene_, records_, scales_);
}

void Presenter::dim(const scene::Scales& scales) {
  if (scales == scales_) return;
  scales_ = scales;
  put_emission(device_, map_, scene_, records_, scales);
}

Shown Presenter::show(std::span<const glm::vec4> irradiance, const Adaptation& adaptation,
                      std::span<const float> covered, std::span<const Over::Instead> instead) {
  gpu::fill<glm::vec4>(device_, map_.total_irradiance, irradiance);
  over_.put({irradiance, map_.size}, instead);
  if (!covered.empty()) gpu::fill<float>(device_, map_.cover, covered);
  gpu::Frame frame(device_, {"present"});
  geometry_texture_.find_shown(frame, map_);
  brdf_.record(frame, map_);
  tone_map_.record(frame, map_, over_, adaptation);
  frame.submit_and_wait();
  return tone_map_.shown(map_);
}

Shown present(const gpu::Device& device, const scene::Scene& scene, const TexelView& irradiance) {
  const TexelRecords records(scene, irradiance.width());
  return Presenter(device, scene, records).show(irradiance.on_host(), {});
}

}  // namespace lichtveld::lightfield
