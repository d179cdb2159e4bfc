#include "passes/over.hpp"

namespace lichtveld::lightfield {

void Over::put(const LightMap& map, const TexelView& irradiance, std::span<const Instead> instead) {
  auto& times = device_.times();
  if (!seams_) times.time("find_seams", [&] { seams_.emplace(scene_, records_); });
  if (!seams_->any() && instead.empty()) return;
  times.time("seams", [&] {
    auto over = seams_->offsets(irradiance.on_host());
    for (const auto& [texel, radiance] : instead) over[texel] = glm::vec4(radiance, 1);
    gpu::fill<glm::vec4>(device_, map.over, over);
  });
}

}  // namespace lichtveld::lightfield
