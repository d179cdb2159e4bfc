// Frame's barriers: each resource remembers its last uses, and every new one waits for what it must, no more.
#include "lichtveld/gpu/frame.hpp"

namespace lichtveld::gpu {

namespace {

using AccessBit = vk::AccessFlagBits2;

// What a resource's next use has to wait for; `needed` is false where no barrier is.
struct Wait {
  vk::PipelineStageFlags2 stages;
  vk::AccessFlags2 access;
  bool needed = false;
};

Wait advance(UseState& state, vk::PipelineStageFlags2 stages, vk::AccessFlags2 access, vk::ImageLayout layout,
             bool writes) {
  const bool transition = layout != state.layout;
  Wait wait;
  if (writes || transition) {
    wait.stages = state.write_stages | state.read_stages;
    wait.access = state.write_access;
    wait.needed = transition || static_cast<bool>(wait.stages);
    // A layout transition is itself a write that later readers in other stages have to wait for.
    state = {.write_stages = stages, .write_access = writes ? access : vk::AccessFlags2{}, .layout = layout};
    if (!writes) {
      state.read_stages = stages;
      state.read_access = access;
    }
  } else if ((state.read_stages & stages) != stages || (state.read_access & access) != access) {
    wait.stages = state.write_stages;
    wait.access = state.write_access;
    wait.needed = static_cast<bool>(wait.stages);
    state.read_stages |= stages;
    state.read_access |= access;
  }
  return wait;
}

}  // namespace

void Frame::use(const Binding& binding, vk::PipelineStageFlags2 stages) {
  const bool sampled = binding.kind == Kind::sampled_image || binding.kind == Kind::texel_buffer;
  const auto read = sampled ? AccessBit::eShaderSampledRead : AccessBit::eShaderStorageRead;
  Access access{stages, read, vk::ImageLayout::eUndefined, binding.writes};
  if (binding.writes) access.access |= AccessBit::eShaderStorageWrite;
  if (binding.image != nullptr) {
    access.layout = binding.kind == Kind::sampled_image ? vk::ImageLayout::eShaderReadOnlyOptimal
                                                        : vk::ImageLayout::eGeneral;
    use(*binding.image, access);
  } else {
    use(*binding.buffer, access);
  }
}

void Frame::use(const Image& image, const Access& access) {
  const auto old_layout = image.state().layout;
  const Wait wait = advance(image.state(), access.stages, access.access, access.layout, access.writes);
  if (!wait.needed) return;
  image_barriers_.push_back({.srcStageMask = wait.stages,
                             .srcAccessMask = wait.access,
                             .dstStageMask = access.stages,
                             .dstAccessMask = access.access,
                             .oldLayout = old_layout,
                             .newLayout = access.layout,
                             .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                             .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                             .image = image.handle(),
                             .subresourceRange = {image.aspect(), 0, 1, 0, image.shape().layers}});
}

void Frame::use(const Buffer& buffer, const Access& access) {
  const Wait wait =
      advance(buffer.state(), access.stages, access.access, vk::ImageLayout::eUndefined, access.writes);
  if (!wait.needed) return;
  buffer_barriers_.push_back({.srcStageMask = wait.stages,
                              .srcAccessMask = wait.access,
                              .dstStageMask = access.stages,
                              .dstAccessMask = access.access,
                              .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                              .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                              .buffer = buffer.handle(),
                              .size = VK_WHOLE_SIZE});
}

void Frame::flush_barriers() {
  if (image_barriers_.empty() && buffer_barriers_.empty()) return;
  commands_.pipelineBarrier2({.bufferMemoryBarrierCount = static_cast<std::uint32_t>(buffer_barriers_.size()),
                              .pBufferMemoryBarriers = buffer_barriers_.data(),
                              .imageMemoryBarrierCount = static_cast<std::uint32_t>(image_barriers_.size()),
                              .pImageMemoryBarriers = image_barriers_.data()});
  image_barriers_.clear();
  buffer_barriers_.clear();
}

}  // namespace lichtveld::gpu
