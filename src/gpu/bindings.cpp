#include "bindings.hpp"

#include <stdexcept>

namespace lichtveld::gpu {

Binding sampled(std::string_view name, const Image& image, const vk::raii::Sampler& sampler) {
  return {.name = name, .kind = Kind::sampled_image, .image = &image, .sampler = *sampler};
}
Binding reads(std::string_view name, const Image& image) {
  return {.name = name, .kind = Kind::storage_image, .image = &image};
}
Binding writes(std::string_view name, const Image& image) {
  return {.name = name, .kind = Kind::storage_image, .image = &image, .writes = true};
}
Binding reads(std::string_view name, const Buffer& buffer) {
  return {.name = name, .kind = Kind::storage_buffer, .buffer = &buffer};
}
Binding writes(std::string_view name, const Buffer& buffer) {
  return {.name = name, .kind = Kind::storage_buffer, .buffer = &buffer, .writes = true};
}
Binding fetches(std::string_view name, const Buffer& buffer) {
  return {.name = name, .kind = Kind::texel_buffer, .buffer = &buffer};
}

void push_descriptors(const vk::raii::CommandBuffer& commands, const Pipeline& pipeline,
                      const std::vector<const Binding*>& matched) {
  std::vector<vk::DescriptorImageInfo> images(matched.size());
  std::vector<vk::DescriptorBufferInfo> buffers(matched.size());
  std::vector<vk::BufferView> views(matched.size());
  std::vector<vk::WriteDescriptorSet> writes;
  for (std::size_t index = 0; index < matched.size(); ++index) {
    const Binding& binding = *matched[index];
    if (binding.image != nullptr)
      images[index] = vk::DescriptorImageInfo{.sampler = binding.sampler,
                                              .imageView = binding.image->view(),
                                              .imageLayout = binding.kind == Kind::sampled_image
                                                                 ? vk::ImageLayout::eShaderReadOnlyOptimal
                                                                 : vk::ImageLayout::eGeneral};
    else if (binding.kind == Kind::texel_buffer)
      views[index] = binding.buffer->texels();
    else
      buffers[index] = vk::DescriptorBufferInfo{.buffer = binding.buffer->handle(), .range = VK_WHOLE_SIZE};
    writes.push_back({.dstBinding = pipeline.interface().slots[index].binding,
                      .descriptorCount = 1,
                      .descriptorType = descriptor_type(binding.kind),
                      .pImageInfo = &images[index],
                      .pBufferInfo = &buffers[index],
                      .pTexelBufferView = &views[index]});
  }
  if (!writes.empty()) commands.pushDescriptorSetKHR(pipeline.bind_point(), pipeline.layout(), 0, writes);
}

void Draw::bind(const GraphicsPipeline& pipeline, const std::vector<Binding>& bindings) {
  const auto matched = match(pipeline.interface(), bindings);
  check_listed(pipeline.interface(), bindings, listed_);
  commands_.bindPipeline(vk::PipelineBindPoint::eGraphics, pipeline.handle());
  push_descriptors(commands_, pipeline, matched);
  bound_ = &pipeline;
  pushed_ = 0;
}

const GraphicsPipeline& Draw::bound() const {
  if (bound_ == nullptr) throw std::logic_error("a draw or its constants before any pipeline is bound");
  return *bound_;
}

void Draw::push_bytes(std::span<const std::byte> bytes) {
  check_push_bytes(bound().interface(), bytes.size());
  commands_.pushConstants<std::byte>(bound().layout(), vk::ShaderStageFlagBits::eAllGraphics, 0, bytes);
  pushed_ = bytes.size();
}

void Draw::stencil_reference(std::uint32_t value) {
  commands_.setStencilReference(vk::StencilFaceFlagBits::eFrontAndBack, value);
}

void Draw::geometry(const Buffer& vertices, const Buffer& indices) {
  commands_.bindVertexBuffers(0, vertices.handle(), vk::DeviceSize{0});
  commands_.bindIndexBuffer(indices.handle(), 0, vk::IndexType::eUint32);
}

void Draw::windows(const std::vector<Window>& windows) {
  std::vector<vk::Viewport> viewports;
  std::vector<vk::Rect2D> scissors;
  for (const auto& window : windows) {
    viewports.push_back({.x = static_cast<float>(window.offset.x),
                         .y = static_cast<float>(window.offset.y),
                         .width = static_cast<float>(window.extent.width),
                         .height = static_cast<float>(window.extent.height),
                         .maxDepth = 1});
    scissors.push_back(window.visible);
  }
  commands_.setViewportWithCount(viewports);
  commands_.setScissorWithCount(scissors);
}

void Draw::indexed(std::uint32_t first, std::uint32_t count, std::uint32_t instances,
                   std::uint32_t first_instance) {
  check_push_bytes(bound().interface(), pushed_);
  if (count > 0) commands_.drawIndexed(count, instances, first, 0, first_instance);
}

void Draw::full_screen_triangle() {
  check_push_bytes(bound().interface(), pushed_);
  commands_.draw(3, 1, 0, 0);
}

}  // namespace lichtveld::gpu
