#include "lichtveld/gpu/transfer.hpp"

namespace lichtveld::gpu {

Image upload_srgb(const Device& device, const std::string& name, std::uint32_t width, std::uint32_t height,
                  std::span<const std::uint8_t> rgba) {
  Image image(device, name, {.width = width, .height = height}, vk::Format::eR8G8B8A8Srgb,
              vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst);
  fill(device, image, rgba);
  return image;
}

}  // namespace lichtveld::gpu
