// Shader pipelines. What a pipeline's resources and push constants are, its shaders say; they are push
// descriptors in set 0 and bound by their names.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lichtveld/gpu/device.hpp"
#include "lichtveld/gpu/shader.hpp"

namespace lichtveld::gpu {

vk::DescriptorType descriptor_type(Kind kind);

// Specialisation constants 0, 1, ..
using Specialisation = std::vector<std::uint32_t>;

class Pipeline {
 public:
  vk::Pipeline handle() const { return *pipeline_; }
  vk::PipelineLayout layout() const { return *layout_; }
  const std::string& name() const { return name_; }
  const Interface& interface() const { return interface_; }
  vk::PipelineBindPoint bind_point() const { return bind_point_; }

 protected:
  Pipeline(const Device& device, std::string name, Interface interface, vk::PipelineBindPoint bind_point);

  std::string name_;
  Interface interface_;
  vk::PipelineBindPoint bind_point_;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr;
  vk::raii::PipelineLayout layout_ = nullptr;
  vk::raii::Pipeline pipeline_ = nullptr;
};

class ComputePipeline : public Pipeline {
 public:
  ComputePipeline(const Device& device, std::string name, const Shader& shader,
                  const Specialisation& specialisation = {});
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
  // Without a fragment shader the pipeline only touches the stencil. Viewport, scissor and stencil reference
  // are dynamic: Frame::render sets the first two to the target's extent.
  GraphicsPipeline(const Device& device, std::string name, const Shader& vertex,
                   const std::optional<Shader>& fragment, const GraphicsState& state,
                   const Specialisation& specialisation = {});
};

}  // namespace lichtveld::gpu
