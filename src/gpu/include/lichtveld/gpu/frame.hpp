// A frame of GPU work: passes in order, each with its debug label, timestamps and barriers, which nothing else
// adds.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lichtveld/gpu/pipeline.hpp"
#include "lichtveld/gpu/resources.hpp"

namespace lichtveld::gpu {

// A resource as a shader sees it. What a pass binds has to be what its shaders declare, in any order: a name
// that they lack, one that is missing or given twice, another kind, reads() of what they may write or writes()
// of what they declare `readonly` throws std::logic_error with the shaders' and the binding's names, in every
// build.
struct Binding {
  std::string_view name;  // in the shader: the variable's; of a storage buffer the block's
  Kind kind;
  const Image* image = nullptr;
  const Buffer* buffer = nullptr;
  vk::Sampler sampler = {};
  bool writes = false;
};
Binding sampled(std::string_view name, const Image& image, const vk::raii::Sampler& sampler);
Binding reads(std::string_view name, const Image& image);    // storage image
Binding writes(std::string_view name, const Image& image);   // storage image; also for reading and writing
Binding reads(std::string_view name, const Buffer& buffer);  // storage buffer
Binding writes(std::string_view name, const Buffer& buffer);
Binding fetches(std::string_view name, const Buffer& buffer);  // as texels

// One colour or stencil attachment of a render pass: one layer of an image, cleared first unless it is kept.
struct Attachment {
  const Image* image;
  std::optional<vk::ClearValue> clear;
  std::uint32_t layer = 0;
};

struct Target {
  vk::Extent2D extent;
  std::vector<Attachment> colours = {};
  std::optional<Attachment> stencil = {};
};

// Where gl_Position lands: [-1, 1] on `extent` pixels from `offset` on, of which only `visible` is drawn.
struct Window {
  vk::Offset2D offset;  // may lie outside the target
  vk::Extent2D extent;
  vk::Rect2D visible;  // in the target
};
// So many at once; a vertex shader names its own by gl_ViewportIndex. Every device with several has these.
constexpr std::uint32_t most_windows = 16;

// Records draws inside Frame::render.
class Draw {
 public:
  // Up to most_windows. Without a call there is one: the whole target.
  void windows(const std::vector<Window>& windows);
  // Binds a pipeline and its resources, which the pass must have listed; throws std::logic_error if it has not.
  void bind(const GraphicsPipeline& pipeline, const std::vector<Binding>& bindings = {});
  // The bound pipeline's constants, once before its draws. Throws std::logic_error if they are of another size.
  template <typename Constants>
  void push(const Constants& constants) {
    push_bytes(std::as_bytes(std::span(&constants, 1)));
  }
  void stencil_reference(std::uint32_t value);
  void geometry(const Buffer& vertices, const Buffer& indices);  // 32-bit indices
  void indexed(std::uint32_t first, std::uint32_t count, std::uint32_t instances = 1,
               std::uint32_t first_instance = 0);
  void full_screen_triangle();

 private:
  friend class Frame;
  Draw(const vk::raii::CommandBuffer& commands, const std::vector<Binding>& listed)
      : commands_(commands), listed_(listed) {}
  void push_bytes(std::span<const std::byte> bytes);
  const GraphicsPipeline& bound() const;

  const vk::raii::CommandBuffer& commands_;
  const std::vector<Binding>& listed_;  // of the pass
  const GraphicsPipeline* bound_ = nullptr;
  std::size_t pushed_ = 0;  // bytes, since it was bound
};

class Frame {
 public:
  // Starts recording. Times of its passes are added to Device::times() when it has been waited for. Captures
  // show its passes under these labels, outermost first: what they are a part of.
  explicit Frame(const Device& device, const std::vector<std::string>& labels = {});
  ~Frame();
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  // A compute pass: what it binds, its push constants, workgroups in x and y. Throws std::logic_error where
  // those are not what the shader declares, std::runtime_error where the device cannot start as many workgroups
  // in x.
  template <typename Constants>
  void compute(const ComputePipeline& pipeline, const std::vector<Binding>& bindings,
               const Constants& constants, std::uint32_t groups_x, std::uint32_t groups_y) {
    compute_bytes(pipeline, bindings, std::as_bytes(std::span(&constants, 1)), groups_x, groups_y);
  }
  void compute(const ComputePipeline& pipeline, const std::vector<Binding>& bindings, std::uint32_t groups_x,
               std::uint32_t groups_y) {
    compute_bytes(pipeline, bindings, {}, groups_x, groups_y);
  }

  // A render pass. `bindings` lists what its shaders touch; `inputs` are vertex and index buffers.
  void render(const std::string& name, const Target& target, const std::vector<Binding>& bindings,
              const std::vector<const Buffer*>& inputs, const std::function<void(Draw&)>& draw);

  // Small jobs that are passes too, so that captures and timers show them.
  void clear(const std::string& name, const Image& image, vk::ClearColorValue value);
  void clear(const std::string& name, const Buffer& buffer, std::uint32_t word = 0);
  void copy(const std::string& name, const Buffer& from, const Buffer& to);
  void copy(const std::string& name, const Image& from, const Buffer& to);  // layer 0, tightly packed
  void copy(const std::string& name, const Buffer& from, const Image& to);

  // Makes what the frame wrote to a host buffer visible to the host.
  void to_host(const Buffer& buffer);

  // Submits: the device works while the host goes on. What the frame uses must outlive the wait for it, which
  // the destructor makes up for.
  void submit();
  // Waits until all is done; reads the timestamps. The frame is then spent.
  void wait();
  void submit_and_wait() {
    submit();
    wait();
  }

 private:
  struct Access {
    vk::PipelineStageFlags2 stages;
    vk::AccessFlags2 access;
    vk::ImageLayout layout = vk::ImageLayout::eUndefined;  // of images
    bool writes = false;
  };
  struct Timed {
    std::string pass;
    std::uint32_t query;  // the start's; the end's follows
  };

  bool has_labels() const;
  void pass(const std::string& name, const std::function<void()>& record);
  void compute_bytes(const ComputePipeline& pipeline, const std::vector<Binding>& bindings,
                     std::span<const std::byte> constants, std::uint32_t groups_x, std::uint32_t groups_y);
  void use(const Binding& binding, vk::PipelineStageFlags2 stages);
  void use(const Image& image, const Access& access);
  void use(const Buffer& buffer, const Access& access);
  void flush_barriers();

  const Device& device_;
  const std::size_t labels_;  // around all passes
  const std::string name_;    // those, joined
  vk::raii::CommandBuffer commands_ = nullptr;
  vk::raii::Fence submitted_ = nullptr;  // until it has been waited for
  std::vector<vk::raii::QueryPool> queries_;
  std::vector<Timed> timed_;
  std::vector<vk::ImageMemoryBarrier2> image_barriers_;
  std::vector<vk::BufferMemoryBarrier2> buffer_barriers_;
};

}  // namespace lichtveld::gpu
