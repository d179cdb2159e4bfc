// Shader pipelines. A pipeline's resources are push descriptors in set 0, bound in the order of its `kinds`.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "lichtveld/gpu/device.hpp"

namespace lichtveld::gpu {

using Spirv = std::span<const std::uint32_t>;

// texel_buffer: read-only; a shader fetches a texel of up to four words at once, which costs a CPU device a
// quarter of as many loads from a storage buffer.
enum class Kind { sampled_image, storage_image, storage_buffer, texel_buffer };

vk::DescriptorType descriptor_type(Kind kind);

// What every pipeline is made of besides its shaders. Specialisation constant i has the id i.
struct Interface {
  std::vector<Kind> kinds = {};  // binding i has kinds[i]
  std::uint32_t push_bytes = 0;  // of push constants, <= 128
  std::vector<std::uint32_t> specialisation = {};
};

class Pipeline {
 public:
  vk::Pipeline handle() const { return *pipeline_; }
  vk::PipelineLayout layout() const { return *layout_; }
  const std::string& name() const { return name_; }
  const std::vector<Kind>& kinds() const { return kinds_; }
  vk::PipelineBindPoint bind_point() const { return bind_point_; }

 protected:
  Pipeline(const Device& device, std::string name, const Interface& interface,
           vk::PipelineBindPoint bind_point);

  std::string name_;
  std::vector<Kind> kinds_;
  vk::PipelineBindPoint bind_point_;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr;
  vk::raii::PipelineLayout layout_ = nullptr;
  vk::raii::Pipeline pipeline_ = nullptr;
};

class ComputePipeline : public Pipeline {
 public:
  ComputePipeline(const Device& device, std::string name, Spirv shader, const Interface& interface);
};

struct VertexAttribute {
  std::uint32_t location;
  vk::Format format;
  std::uint32_t offset;
};

struct GraphicsState {
  std::uint32_t vertex_stride = 0;  // 0: no vertex buffer
  std::vector<VertexAttribute> attributes = {};
  std::vector<vk::Format> colours = {};                // of the attachments
  vk::Format stencil_format = vk::Format::eUndefined;  // eUndefined: no stencil attachment
  vk::StencilOpState stencil = {};                     // front and back alike
  vk::CullModeFlags cull = vk::CullModeFlagBits::eNone;
  vk::FrontFace front = vk::FrontFace::eCounterClockwise;
  std::uint32_t samples = 1;
  std::uint32_t sample_mask = ~0u;
};

class GraphicsPipeline : public Pipeline {
 public:
  // An empty fragment shader makes a pipeline that only touches the stencil. Viewport, scissor and stencil
  // reference are dynamic: Frame::render sets the first two to the target's extent.
  GraphicsPipeline(const Device& device, std::string name, Spirv vertex, Spirv fragment,
                   const Interface& interface, const GraphicsState& state);
};

}  // namespace lichtveld::gpu
