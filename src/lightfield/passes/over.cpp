#include "passes/over.hpp"

namespace lichtveld::lightfield {

Over::Over(const gpu::Device& device, const scene::Scene& scene, const TexelRecords& records)
    : device_(device),
      scene_(scene),
      records_(records),
      numbers_(atlas_image(device, "over_numbers", records.size(), vk::Format::eR32Uint)),
      values_(device, "lightfield/over_values", sizeof(glm::vec4), vk::BufferUsageFlagBits::eStorageBuffer,
              gpu::Memory::host) {}

void Over::put(const TexelView& irradiance, std::span<const Instead> instead) {
  auto& times = device_.times();
  if (!seams_) times.time("find_seams", [&] { find(instead); });
  if (seams_->texels().empty() && instead.empty()) return;
  times.time("seams", [&] {
    std::vector<glm::vec4> values, room;
    for (const auto& offset : seams_->offsets(irradiance.on_host(room))) values.emplace_back(offset, 0);
    for (const auto& [texel, radiance] : instead) values.emplace_back(radiance, 1);
    gpu::put<glm::vec4>(device_, values_, values);
  });
}

void Over::find(std::span<const Instead> instead) {
  seams_.emplace(scene_, records_);
  std::vector<std::uint32_t> numbers(records_.source().size(), 0);
  std::uint32_t count = 0;
  for (const auto texel : seams_->texels()) numbers[texel] = ++count;
  for (const auto& [texel, radiance] : instead) numbers[texel] = ++count;
  gpu::fill<std::uint32_t>(device_, numbers_, numbers);
}

}  // namespace lichtveld::lightfield
