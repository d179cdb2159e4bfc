#include "links/direct_light.hpp"

#include <algorithm>
#include <numbers>

#include "shaders/direct_light.comp.h"

namespace lichtveld::lightfield {

namespace {

// The weights of half of the directions that a texel receives come to pi / 2. Few directions may come to more,
// but never to more than all solid angles of a hemisphere [sr].
constexpr float most_weight = 2 * std::numbers::pi_v<float>;
constexpr float most_sum = 0x1p31f;

float scale_for(const Lamps& lamps) {
  return lamps.brightest() > 0 ? most_sum / (most_weight * lamps.brightest()) : 1;
}

gpu::Buffer scaled(const gpu::Device& device, const Lamps& lamps, float scale) {
  std::vector<glm::vec3> light;
  for (const auto& lamp : lamps.emission()) light.push_back(scale * lamp);
  return gpu::upload<glm::vec3>(device, "lightfield/lamps", light, vk::BufferUsageFlagBits::eStorageBuffer);
}

}  // namespace

DirectLight::DirectLight(const gpu::Device& device, const scene::Scene& scene, const LinkTable& table,
                         Direct way)
    : device_(device),
      records_(table.records),
      sum_(device, "direct_light", shaders::direct_light_comp, {table.bits}),
      scale_(scale_for(table.records.lamps())),
      lamps_(scaled(device, table.records.lamps(), scale_)),
      sums_(device, "lightfield/direct_light", std::uint64_t{table.texels} * 2 * sizeof(glm::uvec3),
            vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst),
      irradiance_(device, "lightfield/lamp_irradiance", std::uint64_t{table.texels} * sizeof(glm::vec4),
                  vk::BufferUsageFlagBits::eStorageBuffer, gpu::Memory::host) {
  std::ranges::fill(irradiance_.as<glm::vec4>(), glm::vec4(0));
  if (way == Direct::exact) {
    index_ = std::make_unique<scene::RayIndex>(scene);
    exact_.emplace(*index_, scene, records_.all(), records_.size());
  }
  gpu::Frame frame(device);
  frame.clear("direct_light", sums_);
  frame.submit_and_wait();
}

void DirectLight::light(const scene::Offsets& offsets, const scene::Scales& scales, const Moves& moves) {
  if (!exact_) return;
  const gpu::TimeLedger::Stage stage(device_.times(), "direct_light");
  exact_->light(offsets, scales, moves);
  const auto irradiance = irradiance_.as<glm::vec4>();
  for (std::size_t texel = 0; texel < irradiance.size(); ++texel)
    irradiance[texel] = glm::vec4(exact_->irradiance()[texel], 0);
}

void DirectLight::add_half_difference(std::span<glm::vec4> atlas) const {
  if (!exact_) return;
  for (std::uint32_t texel = 0; texel < records_.count(); ++texel)
    atlas[records_[texel].atlas] +=
        glm::vec4(exact_->half_difference(texel, false) + exact_->half_difference(texel, true), 0);
}

void DirectLight::sum(gpu::Frame& frame, const LightMap& map, const LinkTable& table,
                      const gpu::Buffer& directions) const {
  frame.clear("direct_light", sums_);
  for (const auto& chunk : table.chunks)
    frame.compute(sum_,
                  {gpu::reads("Table", chunk.links), gpu::fetches("directions", directions),
                   gpu::reads("TexelOf", table.texel_of), gpu::reads("normal", map.normal),
                   gpu::reads("Lamps", lamps_), gpu::writes("Direct", sums_)},
                  shaders::DirectConstants{.texels = table.texels,
                                           .first_pair = chunk.first_pair,
                                           .pairs = chunk.pairs,
                                           .lamps = linked_lamps(),
                                           .half_pairs = table.pairs / 2},
                  table.groups(), 1);
}

}  // namespace lichtveld::lightfield
