// Whole buffers and images between host and device; what no host buffer holds as a frame of its own.
#pragma once

#include <algorithm>
#include <cstring>

#include "lichtveld/gpu/frame.hpp"

namespace lichtveld::gpu {

// A device buffer with these contents (at least one element is made, so that empty scenes bind). `texels`: as a
// Buffer's.
template <typename T>
Buffer upload(const Device& device, const std::string& name, std::span<const T> contents,
              vk::BufferUsageFlags usage, vk::Format texels = vk::Format::eUndefined) {
  const vk::DeviceSize bytes = std::max<vk::DeviceSize>(sizeof(T), contents.size_bytes());
  Buffer staging(device, name + " (staging)", bytes, vk::BufferUsageFlagBits::eTransferSrc, Memory::host);
  std::ranges::copy(std::as_bytes(contents), staging.bytes().begin());
  Buffer buffer(device, name, bytes, usage | vk::BufferUsageFlagBits::eTransferDst, Memory::device, texels);
  Frame frame(device);
  frame.copy("upload", staging, buffer);
  frame.submit_and_wait();
  return buffer;
}

// Fills a host buffer from its beginning; one that is too small is replaced by one with room to spare. Not
// while a frame that uses it is recorded or under way.
template <typename T>
void put(const Device& device, Buffer& buffer, std::span<const T> contents) {
  const vk::DeviceSize bytes = contents.size_bytes();
  if (bytes > buffer.size()) {
    const auto room = std::max(bytes, std::min(2 * bytes, device.summary().max_storage_buffer));
    buffer = Buffer(device, buffer.name(), room, vk::BufferUsageFlagBits::eStorageBuffer, Memory::host,
                    buffer.texel_format());
  }
  std::ranges::copy(std::as_bytes(contents), buffer.bytes().begin());
}

// Fills an image's layer 0, row 0 first; T is as large as a pixel. The image needs eTransferDst.
template <typename T>
void fill(const Device& device, const Image& image, std::span<const T> pixels) {
  Buffer staging(device, image.name() + " (staging)", pixels.size_bytes(),
                 vk::BufferUsageFlagBits::eTransferSrc, Memory::host);
  std::ranges::copy(std::as_bytes(pixels), staging.bytes().begin());
  Frame frame(device);
  frame.copy("upload", staging, image);
  frame.submit_and_wait();
}

// The pixels of layer 0, row 0 first; T is as large as a pixel. The image needs eTransferSrc.
template <typename T>
std::vector<T> download(const Device& device, const Image& image) {
  std::vector<T> pixels(std::size_t{image.shape().width} * image.shape().height);
  Buffer staging(device, image.name() + " (read back)", pixels.size() * sizeof(T),
                 vk::BufferUsageFlagBits::eTransferDst, Memory::host);
  Frame frame(device);
  frame.copy("read_back", image, staging);
  frame.to_host(staging);
  frame.submit_and_wait();
  std::memcpy(pixels.data(), staging.bytes().data(), pixels.size() * sizeof(T));
  return pixels;
}

}  // namespace lichtveld::gpu
