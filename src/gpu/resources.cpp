#include "lichtveld/gpu/resources.hpp"

#include <utility>
#include <vulkan/vulkan_format_traits.hpp>

namespace lichtveld::gpu {

namespace {

vk::raii::DeviceMemory allocate(const Device& device, const vk::MemoryRequirements& needs, Memory where,
                                const std::string& name) {
  const auto flags = where == Memory::host
                         ? vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent
                         : vk::MemoryPropertyFlags{vk::MemoryPropertyFlagBits::eDeviceLocal};
  try {
    vk::raii::DeviceMemory memory(
        device.handle(),
        {.allocationSize = needs.size, .memoryTypeIndex = device.memory_type(needs.memoryTypeBits, flags)});
    device.name(memory, name);
    return memory;
  } catch (const vk::OutOfDeviceMemoryError&) {
    throw std::runtime_error(name + ": the device has no " + std::to_string(needs.size >> 20) +
                             " MiB left; try a smaller --size or fewer --layers");
  }
}

// Throws if shaders could not see all of it.
vk::BufferUsageFlags usage_for(const Device& device, const std::string& name, vk::DeviceSize bytes,
                               vk::BufferUsageFlags usage, vk::Format texels) {
  const auto& summary = device.summary();
  if ((usage & vk::BufferUsageFlagBits::eStorageBuffer) && bytes > summary.max_storage_buffer)
    throw std::runtime_error(name + ": " + std::to_string(bytes >> 20) + " MiB, more than the " +
                             std::to_string(summary.max_storage_buffer >> 20) + " MiB that " + summary.name +
                             " has for one buffer; try a smaller --size");
  if (texels == vk::Format::eUndefined) return usage;
  const auto count = bytes / vk::blockSize(texels), most = summary.max_texel_buffer;
  if (count > most)
    throw std::runtime_error(name + ": " + std::to_string(count) + " texels, more than the device's " +
                             std::to_string(most) + " for one buffer; try a smaller --size");
  return usage | vk::BufferUsageFlagBits::eUniformTexelBuffer;
}

bool is_stencil(vk::Format format) {
  return format == vk::Format::eS8Uint || format == vk::Format::eD32SfloatS8Uint;
}

}  // namespace

LedgerEntry::LedgerEntry(std::shared_ptr<MemoryLedger> ledger, std::string name, std::uint64_t bytes)
    : ledger_(std::move(ledger)), name_(std::move(name)), bytes_(bytes) {
  ledger_->add(name_, bytes_);
}

LedgerEntry::~LedgerEntry() {
  if (ledger_) ledger_->remove(name_, bytes_);
}

LedgerEntry& LedgerEntry::operator=(LedgerEntry&& other) noexcept {
  std::swap(ledger_, other.ledger_);
  std::swap(name_, other.name_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

Buffer::Buffer(const Device& device, std::string name, vk::DeviceSize bytes, vk::BufferUsageFlags usage,
               Memory where, vk::Format texels)
    : name_(std::move(name)),
      bytes_(bytes),
      texel_format_(texels),
      buffer_(device.handle(),
              vk::BufferCreateInfo{.size = bytes, .usage = usage_for(device, name_, bytes, usage, texels)}),
      memory_(allocate(device, buffer_.getMemoryRequirements(), where, name_)),
      entry_(device.ledger(), name_, buffer_.getMemoryRequirements().size) {
  device.name(buffer_, name_);
  buffer_.bindMemory(*memory_, 0);
  if (where == Memory::host) mapped_ = memory_.mapMemory(0, VK_WHOLE_SIZE);
  if (texels == vk::Format::eUndefined) return;
  texels_ = {device.handle(),
             vk::BufferViewCreateInfo{.buffer = *buffer_, .format = texels, .range = VK_WHOLE_SIZE}};
  device.name(texels_, name_);
}

Image::Image(const Device& device, std::string name, ImageShape shape, vk::Format format,
             vk::ImageUsageFlags usage)
    : name_(std::move(name)),
      shape_(shape),
      format_(format),
      aspect_(is_stencil(format) ? vk::ImageAspectFlagBits::eStencil : vk::ImageAspectFlagBits::eColor),
      image_(device.handle(),
             vk::ImageCreateInfo{.imageType = vk::ImageType::e2D,
                                 .format = format,
                                 .extent = {shape.width, shape.height, 1},
                                 .mipLevels = 1,
                                 .arrayLayers = shape.layers,
                                 .samples = static_cast<vk::SampleCountFlagBits>(shape.samples),
                                 .tiling = vk::ImageTiling::eOptimal,
                                 .usage = usage}),
      memory_(allocate(device, image_.getMemoryRequirements(), Memory::device, name_)),
      entry_(device.ledger(), name_, image_.getMemoryRequirements().size) {
  device.name(image_, name_);
  image_.bindMemory(*memory_, 0);
  const auto make_view = [&](vk::ImageViewType type, std::uint32_t first, std::uint32_t count) {
    vk::raii::ImageView view(device.handle(),
                             vk::ImageViewCreateInfo{.image = *image_,
                                                     .viewType = type,
                                                     .format = format_,
                                                     .subresourceRange = {aspect_, 0, 1, first, count}});
    device.name(view, name_);
    return view;
  };
  view_ = make_view(shape.array ? vk::ImageViewType::e2DArray : vk::ImageViewType::e2D, 0, shape.layers);
  for (std::uint32_t layer = 0; layer < shape.layers; ++layer)
    layer_views_.push_back(make_view(vk::ImageViewType::e2D, layer, 1));
}

}  // namespace lichtveld::gpu
