// Buffers and images that own their memory and cannot be made without a name. Each remembers how it was last
// used, so that Frame can put the right barrier before its next use.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lichtveld/gpu/device.hpp"

namespace lichtveld::gpu {

// The last uses of a resource: what a barrier has to wait for.
struct UseState {
  vk::PipelineStageFlags2 write_stages = {}, read_stages = {};
  vk::AccessFlags2 write_access = {}, read_access = {};
  vk::ImageLayout layout = vk::ImageLayout::eUndefined;
};

// A resource's share of the memory ledger, for as long as it lives.
class LedgerEntry {
 public:
  LedgerEntry(std::shared_ptr<MemoryLedger> ledger, std::string name, std::uint64_t bytes);
  ~LedgerEntry();
  LedgerEntry(LedgerEntry&&) noexcept = default;
  LedgerEntry& operator=(LedgerEntry&&) noexcept;

 private:
  std::shared_ptr<MemoryLedger> ledger_;
  std::string name_;
  std::uint64_t bytes_ = 0;
};

enum class Memory { device, host };  // host: mapped and coherent

class Buffer {
 public:
  // Throws std::runtime_error that names the buffer and its size when the device cannot hold it, or shaders
  // could not see all of it. With a format, they may also fetch it as texels (Kind::texel_buffer).
  Buffer(const Device& device, std::string name, vk::DeviceSize bytes, vk::BufferUsageFlags usage,
         Memory where = Memory::device, vk::Format texels = vk::Format::eUndefined);

  vk::Buffer handle() const { return *buffer_; }
  vk::BufferView texels() const { return *texels_; }  // null without a format
  vk::DeviceSize size() const { return bytes_; }
  vk::Format texel_format() const { return texel_format_; }  // eUndefined: not fetched
  const std::string& name() const { return name_; }
  UseState& state() const { return *state_; }

  // The bytes of a host buffer. Read after the frame that wrote it (with Frame::to_host) has been waited for.
  std::span<std::byte> bytes() const { return {static_cast<std::byte*>(mapped_), bytes_}; }
  template <typename T>
  std::span<T> as() const {
    return {static_cast<T*>(mapped_), bytes_ / sizeof(T)};
  }

 private:
  std::string name_;
  vk::DeviceSize bytes_;
  vk::Format texel_format_;
  vk::raii::Buffer buffer_ = nullptr;
  vk::raii::DeviceMemory memory_ = nullptr;
  vk::raii::BufferView texels_ = nullptr;
  void* mapped_ = nullptr;
  std::unique_ptr<UseState> state_ = std::make_unique<UseState>();
  LedgerEntry entry_;
};

struct ImageShape {
  std::uint32_t width = 1, height = 1, layers = 1, samples = 1;
  bool array = false;  // seen by shaders as an array, even of one layer
};

class Image {
 public:
  // A 2D image or an array of them; of colour or stencil by its format.
  Image(const Device& device, std::string name, ImageShape shape, vk::Format format, vk::ImageUsageFlags usage);

  vk::Image handle() const { return *image_; }
  vk::ImageView view() const { return *view_; }  // of all layers
  vk::ImageView layer_view(std::uint32_t layer) const {
    return *layer_views_.at(layer);
  }  // of one, to render to
  const ImageShape& shape() const { return shape_; }
  vk::Extent2D extent() const { return {shape_.width, shape_.height}; }
  vk::Format format() const { return format_; }
  vk::ImageAspectFlags aspect() const { return aspect_; }
  const std::string& name() const { return name_; }
  UseState& state() const { return *state_; }

 private:
  std::string name_;
  ImageShape shape_;
  vk::Format format_;
  vk::ImageAspectFlags aspect_;
  vk::raii::Image image_ = nullptr;
  vk::raii::DeviceMemory memory_ = nullptr;
  vk::raii::ImageView view_ = nullptr;
  std::vector<vk::raii::ImageView> layer_views_;
  std::unique_ptr<UseState> state_ = std::make_unique<UseState>();
  LedgerEntry entry_;
};

}  // namespace lichtveld::gpu
