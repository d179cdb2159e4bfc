#include "lichtveld/gpu/pipeline.hpp"

#include <utility>

#include "reflection.hpp"

namespace lichtveld::gpu {

namespace {

vk::ShaderStageFlags stages_of(vk::PipelineBindPoint bind_point) {
  return bind_point == vk::PipelineBindPoint::eCompute ? vk::ShaderStageFlagBits::eCompute
                                                       : vk::ShaderStageFlagBits::eAllGraphics;
}

vk::raii::ShaderModule make_module(const Device& device, const Shader& shader) {
  vk::raii::ShaderModule module(
      device.handle(),
      vk::ShaderModuleCreateInfo{.codeSize = shader.words.size_bytes(), .pCode = shader.words.data()});
  device.name(module, std::string(shader.name));
  return module;
}

class SpecialisationInfo {
 public:
  explicit SpecialisationInfo(const Specialisation& values) {
    for (std::uint32_t id = 0; id < values.size(); ++id)
      entries_.push_back({.constantID = id, .offset = id * 4, .size = 4});
    info_ = {.mapEntryCount = static_cast<std::uint32_t>(entries_.size()),
             .pMapEntries = entries_.data(),
             .dataSize = values.size() * 4,
             .pData = values.data()};
  }
  const vk::SpecializationInfo* get() const { return &info_; }

 private:
  std::vector<vk::SpecializationMapEntry> entries_;
  vk::SpecializationInfo info_;
};

}  // namespace

vk::DescriptorType descriptor_type(Kind kind) {
  constexpr vk::DescriptorType types[] = {vk::DescriptorType::eCombinedImageSampler,
                                          vk::DescriptorType::eStorageImage, vk::DescriptorType::eStorageBuffer,
                                          vk::DescriptorType::eUniformTexelBuffer};
  return types[static_cast<int>(kind)];
}

Pipeline::Pipeline(const Device& device, std::string name, Interface interface,
                   vk::PipelineBindPoint bind_point)
    : name_(std::move(name)), interface_(std::move(interface)), bind_point_(bind_point) {
  std::vector<vk::DescriptorSetLayoutBinding> bindings;
  for (const Slot& slot : interface_.slots)
    bindings.push_back({.binding = slot.binding,
                        .descriptorType = descriptor_type(slot.kind),
                        .descriptorCount = 1,
                        .stageFlags = stages_of(bind_point)});
  set_layout_ = {device.handle(), vk::DescriptorSetLayoutCreateInfo{
                                      .flags = vk::DescriptorSetLayoutCreateFlagBits::ePushDescriptorKHR,
                                      .bindingCount = static_cast<std::uint32_t>(bindings.size()),
                                      .pBindings = bindings.data()}};
  const vk::PushConstantRange range{.stageFlags = stages_of(bind_point), .size = interface_.push_bytes};
  layout_ = {device.handle(),
             vk::PipelineLayoutCreateInfo{.setLayoutCount = 1,
                                          .pSetLayouts = &*set_layout_,
                                          .pushConstantRangeCount = interface_.push_bytes > 0 ? 1u : 0u,
                                          .pPushConstantRanges = &range}};
  device.name(set_layout_, name_);
  device.name(layout_, name_);
}

ComputePipeline::ComputePipeline(const Device& device, std::string name, const Shader& shader,
                                 const Specialisation& specialisation)
    : Pipeline(device, std::move(name), reflect(shader), vk::PipelineBindPoint::eCompute) {
  const TimeLedger::Stage stage(device.times(), "pipelines");
  const auto module = make_module(device, shader);
  const SpecialisationInfo specialised(specialisation);
  pipeline_ = {device.handle(), nullptr,
               vk::ComputePipelineCreateInfo{.stage = {.stage = vk::ShaderStageFlagBits::eCompute,
                                                       .module = *module,
                                                       .pName = "main",
                                                       .pSpecializationInfo = specialised.get()},
                                             .layout = *layout_}};
  device.name(pipeline_, name_);
}

GraphicsPipeline::GraphicsPipeline(const Device& device, std::string name, const Shader& vertex,
                                   const std::optional<Shader>& fragment, const GraphicsState& state,
                                   const Specialisation& specialisation)
    : Pipeline(device, std::move(name), fragment ? merge(reflect(vertex), reflect(*fragment)) : reflect(vertex),
               vk::PipelineBindPoint::eGraphics) {
  const TimeLedger::Stage stage(device.times(), "pipelines");
  const SpecialisationInfo specialised(specialisation);
  const auto vertex_module = make_module(device, vertex);
  vk::raii::ShaderModule fragment_module = nullptr;
  std::vector<vk::PipelineShaderStageCreateInfo> stages = {{.stage = vk::ShaderStageFlagBits::eVertex,
                                                            .module = *vertex_module,
                                                            .pName = "main",
                                                            .pSpecializationInfo = specialised.get()}};
  if (fragment) {
    fragment_module = make_module(device, *fragment);
    stages.push_back({.stage = vk::ShaderStageFlagBits::eFragment,
                      .module = *fragment_module,
                      .pName = "main",
                      .pSpecializationInfo = specialised.get()});
  }

  const vk::VertexInputBindingDescription binding{.stride = state.vertex_stride};
  std::vector<vk::VertexInputAttributeDescription> attributes;
  for (const auto& attribute : state.attributes)
    attributes.push_back(
        {.location = attribute.location, .format = attribute.format, .offset = attribute.offset});
  const vk::PipelineVertexInputStateCreateInfo input{
      .vertexBindingDescriptionCount = state.vertex_stride > 0 ? 1u : 0u,
      .pVertexBindingDescriptions = &binding,
      .vertexAttributeDescriptionCount = static_cast<std::uint32_t>(attributes.size()),
      .pVertexAttributeDescriptions = attributes.data()};
  const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = vk::PrimitiveTopology::eTriangleList};
  const vk::PipelineViewportStateCreateInfo viewport;  // dynamic
  const vk::PipelineRasterizationStateCreateInfo raster{
      .cullMode = state.cull, .frontFace = state.front, .lineWidth = 1};
  const vk::PipelineMultisampleStateCreateInfo multisample{
      .rasterizationSamples = static_cast<vk::SampleCountFlagBits>(state.samples),
      .pSampleMask = &state.sample_mask};
  const bool stencil = state.stencil_format != vk::Format::eUndefined;
  const vk::PipelineDepthStencilStateCreateInfo depth_stencil{
      .stencilTestEnable = stencil, .front = state.stencil, .back = state.stencil};
  const vk::PipelineColorBlendAttachmentState write_all{
      .colorWriteMask = fragment ? vk::ColorComponentFlagBits::eR | vk::ColorComponentFlagBits::eG |
                                       vk::ColorComponentFlagBits::eB | vk::ColorComponentFlagBits::eA
                                 : vk::ColorComponentFlags{}};
  const std::vector blends(state.colours.size(), write_all);
  const vk::PipelineColorBlendStateCreateInfo blend{
      .attachmentCount = static_cast<std::uint32_t>(blends.size()), .pAttachments = blends.data()};
  const vk::DynamicState dynamic_states[] = {vk::DynamicState::eViewportWithCount,
                                             vk::DynamicState::eScissorWithCount,
                                             vk::DynamicState::eStencilReference};
  const vk::PipelineDynamicStateCreateInfo dynamic{.dynamicStateCount = stencil ? 3u : 2u,
                                                   .pDynamicStates = dynamic_states};
  const vk::PipelineRenderingCreateInfo rendering{
      .colorAttachmentCount = static_cast<std::uint32_t>(state.colours.size()),
      .pColorAttachmentFormats = state.colours.data(),
      .stencilAttachmentFormat = state.stencil_format};
  pipeline_ = {device.handle(), nullptr,
               vk::GraphicsPipelineCreateInfo{.pNext = &rendering,
                                              .stageCount = static_cast<std::uint32_t>(stages.size()),
                                              .pStages = stages.data(),
                                              .pVertexInputState = &input,
                                              .pInputAssemblyState = &assembly,
                                              .pViewportState = &viewport,
                                              .pRasterizationState = &raster,
                                              .pMultisampleState = &multisample,
                                              .pDepthStencilState = &depth_stencil,
                                              .pColorBlendState = &blend,
                                              .pDynamicState = &dynamic,
                                              .layout = *layout_}};
  device.name(pipeline_, name_);
}

}  // namespace lichtveld::gpu
