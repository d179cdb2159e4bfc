#include "direct_light.hpp"

#include <algorithm>
#include <numbers>

namespace lichtveld::lightfield {

namespace {

// The weights of half of the directions that a texel receives come to pi / 2. Few directions may come to more,
// but never to more than all solid angles of a hemisphere [sr].
constexpr float most_weight = 2 * std::numbers::pi_v<float>;
constexpr float most_sum = 0x1p31f;

float scale_for(const std::vector<glm::vec3>& lamps) {
  float most = 0;
  for (const auto& lamp : lamps) most = std::max({most, lamp.r, lamp.g, lamp.b});
  return most > 0 ? most_sum / (most_weight * most) : 1;
}

gpu::Buffer scaled(const gpu::Device& device, const std::vector<glm::vec3>& lamps, float scale) {
  std::vector<glm::vec3> light;
  for (const auto& lamp : lamps) light.push_back(scale * lamp);
  return gpu::upload<glm::vec3>(device, "lightfield/lamps", light, vk::BufferUsageFlagBits::eStorageBuffer);
}

}  // namespace

DirectLight::DirectLight(const gpu::Device& device, const LinkTable& table)
    : scale(scale_for(table.lamps)),
      lamps(scaled(device, table.lamps, scale)),
      sums(device, "lightfield/direct_light", std::uint64_t{table.texels} * 2 * sizeof(glm::uvec3),
           vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst) {
  gpu::PassTimes times;
  gpu::Frame frame(device, times);
  frame.clear("route_links", sums);
  frame.submit_and_wait();
}

}  // namespace lichtveld::lightfield
