#include "lichtveld/gpu/transfer.hpp"

namespace lichtveld::gpu {

Image upload_srgb(const Device& device, const std::string& name, std::uint32_t width, std::uint32_t height,
                  std::span<const std::uint8_t> rgba) {
  Buffer staging(device, name + " (staging)", rgba.size(), vk::BufferUsageFlagBits::eTransferSrc, Memory::host);
  std::memcpy(staging.bytes().data(), rgba.data(), rgba.size());
  Image image(device, name, {.width = width, .height = height}, vk::Format::eR8G8B8A8Srgb,
              vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst);
  PassTimes times;
  Frame frame(device, times);
  frame.copy("upload " + name, staging, image);
  frame.submit_and_wait();
  return image;
}

}  // namespace lichtveld::gpu
