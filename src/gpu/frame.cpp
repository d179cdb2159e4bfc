#include "lichtveld/gpu/frame.hpp"

#include <utility>

#include "bindings.hpp"

namespace lichtveld::gpu {

namespace {

using Stage = vk::PipelineStageFlagBits2;
using AccessBit = vk::AccessFlagBits2;

constexpr std::uint32_t queries_a_pool = 1024;

vk::RenderingAttachmentInfo attachment_info(const Attachment& attachment, vk::ImageLayout layout) {
  return {.imageView = attachment.image->layer_view(attachment.layer),
          .imageLayout = layout,
          .loadOp = attachment.clear ? vk::AttachmentLoadOp::eClear : vk::AttachmentLoadOp::eLoad,
          .storeOp = vk::AttachmentStoreOp::eStore,
          .clearValue = attachment.clear.value_or(vk::ClearValue{})};
}

std::string joined(const std::vector<std::string>& labels) {
  std::string name = "frame";
  for (const auto& label : labels) name.append("/").append(label);
  return name;
}

}  // namespace

Frame::Frame(const Device& device, const std::vector<std::string>& labels)
    : device_(device), labels_(labels.size()), name_(joined(labels)) {
  commands_ = std::move(vk::raii::CommandBuffers(device.handle(), {.commandPool = *device.commands(),
                                                                   .level = vk::CommandBufferLevel::ePrimary,
                                                                   .commandBufferCount = 1})
                            .front());
  commands_.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  device_.name(commands_, name_);  // now: RenderDoc forgets what was said of it before
  if (has_labels())
    for (const auto& label : labels) commands_.beginDebugUtilsLabelEXT({.pLabelName = label.c_str()});
}

Frame::~Frame() {
  if (!*submitted_) return;
  try {
    wait();
  } catch (const std::exception&) {
    // The device is lost: nothing is under way any more, and whoever uses it next is told.
  }
}

bool Frame::has_labels() const {
  return device_.handle().getDispatcher()->vkCmdBeginDebugUtilsLabelEXT != nullptr;
}

void Frame::pass(const std::string& name, const std::function<void()>& record) {
  const auto query = static_cast<std::uint32_t>(2 * timed_.size());
  if (query % queries_a_pool == 0) {
    queries_.emplace_back(device_.handle(), vk::QueryPoolCreateInfo{.queryType = vk::QueryType::eTimestamp,
                                                                    .queryCount = queries_a_pool});
    device_.name(queries_.back(), "frame/timestamps");
    commands_.resetQueryPool(*queries_.back(), 0, queries_a_pool);
  }
  timed_.push_back({name, query});
  if (has_labels()) commands_.beginDebugUtilsLabelEXT({.pLabelName = name.c_str()});
  // Barriers stand inside the timestamps: waiting for its inputs is a part of a pass.
  commands_.writeTimestamp2(Stage::eAllCommands, *queries_.back(), query % queries_a_pool);
  flush_barriers();
  record();
  commands_.writeTimestamp2(Stage::eAllCommands, *queries_.back(), query % queries_a_pool + 1);
  if (has_labels()) commands_.endDebugUtilsLabelEXT();
}

void Frame::compute_bytes(const ComputePipeline& pipeline, const std::vector<Binding>& bindings,
                          std::span<const std::byte> constants, std::uint32_t groups_x,
                          std::uint32_t groups_y) {
  if (groups_x > device_.summary().max_groups)
    throw std::runtime_error(pipeline.name() + ": " + std::to_string(groups_x) + " workgroups, more than the " +
                             std::to_string(device_.summary().max_groups) + " that " + device_.summary().name +
                             " starts at once; try a smaller --size");
  const auto matched = match(pipeline.interface(), bindings);
  check_push_bytes(pipeline.interface(), constants.size());
  for (const Binding& binding : bindings) use(binding, Stage::eComputeShader);
  pass(pipeline.name(), [&] {
    commands_.bindPipeline(vk::PipelineBindPoint::eCompute, pipeline.handle());
    push_descriptors(commands_, pipeline, matched);
    if (!constants.empty())
      commands_.pushConstants<std::byte>(pipeline.layout(), vk::ShaderStageFlagBits::eCompute, 0, constants);
    commands_.dispatch(groups_x, groups_y, 1);
  });
}

void Frame::render(const std::string& name, const Target& target, const std::vector<Binding>& bindings,
                   const std::vector<const Buffer*>& inputs, const std::function<void(Draw&)>& draw) {
  for (const Binding& binding : bindings) use(binding, Stage::eVertexShader | Stage::eFragmentShader);
  for (const Buffer* input : inputs)
    use(*input, {Stage::eVertexInput, AccessBit::eVertexAttributeRead | AccessBit::eIndexRead});
  std::vector<vk::RenderingAttachmentInfo> colours;
  for (const Attachment& colour : target.colours) {
    use(*colour.image,
        {Stage::eColorAttachmentOutput, AccessBit::eColorAttachmentRead | AccessBit::eColorAttachmentWrite,
         vk::ImageLayout::eColorAttachmentOptimal, true});
    colours.push_back(attachment_info(colour, vk::ImageLayout::eColorAttachmentOptimal));
  }
  vk::RenderingAttachmentInfo stencil;
  if (target.stencil) {
    use(*target.stencil->image,
        {Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
         AccessBit::eDepthStencilAttachmentRead | AccessBit::eDepthStencilAttachmentWrite,
         vk::ImageLayout::eDepthStencilAttachmentOptimal, true});
    stencil = attachment_info(*target.stencil, vk::ImageLayout::eDepthStencilAttachmentOptimal);
  }
  pass(name, [&] {
    commands_.beginRendering({.renderArea = {{0, 0}, target.extent},
                              .layerCount = 1,
                              .colorAttachmentCount = static_cast<std::uint32_t>(colours.size()),
                              .pColorAttachments = colours.data(),
                              .pStencilAttachment = target.stencil ? &stencil : nullptr});
    Draw recorder(commands_, bindings);
    recorder.windows({{{{0, 0}, target.extent, {{0, 0}, target.extent}}}});
    draw(recorder);
    commands_.endRendering();
  });
}

void Frame::clear(const std::string& name, const Image& image, vk::ClearColorValue value) {
  use(image, {Stage::eClear, AccessBit::eTransferWrite, vk::ImageLayout::eTransferDstOptimal, true});
  pass(name, [&] {
    commands_.clearColorImage(image.handle(), vk::ImageLayout::eTransferDstOptimal, value,
                              vk::ImageSubresourceRange{image.aspect(), 0, 1, 0, image.shape().layers});
  });
}

void Frame::clear(const std::string& name, const Buffer& buffer, std::uint32_t word) {
  // The specification counts a fill as a clear, the validation layers (1.3.239) as a copy: wait for either.
  use(buffer, {Stage::eAllTransfer, AccessBit::eTransferWrite, vk::ImageLayout::eUndefined, true});
  pass(name, [&] { commands_.fillBuffer(buffer.handle(), 0, VK_WHOLE_SIZE, word); });
}

void Frame::copy(const std::string& name, const Buffer& from, const Buffer& to) {
  use(from, {Stage::eCopy, AccessBit::eTransferRead});
  use(to, {Stage::eCopy, AccessBit::eTransferWrite, vk::ImageLayout::eUndefined, true});
  pass(name, [&] { commands_.copyBuffer(from.handle(), to.handle(), vk::BufferCopy{.size = from.size()}); });
}

namespace {
vk::BufferImageCopy whole(const Image& image) {
  return {.imageSubresource = {image.aspect(), 0, 0, 1},
          .imageExtent = {image.shape().width, image.shape().height, 1}};
}
}  // namespace

void Frame::copy(const std::string& name, const Image& from, const Buffer& to) {
  use(from, {Stage::eCopy, AccessBit::eTransferRead, vk::ImageLayout::eTransferSrcOptimal});
  use(to, {Stage::eCopy, AccessBit::eTransferWrite, vk::ImageLayout::eUndefined, true});
  pass(name, [&] {
    commands_.copyImageToBuffer(from.handle(), vk::ImageLayout::eTransferSrcOptimal, to.handle(), whole(from));
  });
}

void Frame::copy(const std::string& name, const Buffer& from, const Image& to) {
  use(from, {Stage::eCopy, AccessBit::eTransferRead});
  use(to, {Stage::eCopy, AccessBit::eTransferWrite, vk::ImageLayout::eTransferDstOptimal, true});
  pass(name, [&] {
    commands_.copyBufferToImage(from.handle(), to.handle(), vk::ImageLayout::eTransferDstOptimal, whole(to));
  });
}

void Frame::to_host(const Buffer& buffer) {
  use(buffer, {Stage::eHost, AccessBit::eHostRead});
}

void Frame::submit() {
  flush_barriers();
  if (has_labels())
    for (std::size_t label = 0; label < labels_; ++label) commands_.endDebugUtilsLabelEXT();
  commands_.end();
  vk::raii::Fence fence(device_.handle(), vk::FenceCreateInfo{});
  device_.name(fence, name_);
  const vk::CommandBufferSubmitInfo submit{.commandBuffer = *commands_};
  device_.queue().submit2(vk::SubmitInfo2{.commandBufferInfoCount = 1, .pCommandBufferInfos = &submit}, *fence);
  submitted_ = std::move(fence);
}

void Frame::wait() {
  const auto fence = std::exchange(submitted_, nullptr);
  const auto start = std::chrono::steady_clock::now();
  if (device_.handle().waitForFences(*fence, true, UINT64_MAX) != vk::Result::eSuccess)
    throw std::runtime_error("the device did not finish a frame");
  const auto waited = std::chrono::steady_clock::now() - start;
  std::vector<std::uint64_t> ticks;
  for (std::size_t pool = 0; pool < queries_.size(); ++pool) {
    const auto used = std::min<std::size_t>(queries_a_pool, 2 * timed_.size() - pool * queries_a_pool);
    const auto [result, values] =
        queries_[pool].getResults<std::uint64_t>(0, static_cast<std::uint32_t>(used), used * 8, 8,
                                                 vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
    ticks.insert(ticks.end(), values.begin(), values.end());
  }
  double all_ms = 0;
  for (const Timed& timed : timed_) {
    const auto took = ticks[timed.query + 1] - ticks[timed.query];
    const double ms = static_cast<double>(took) * device_.timestamp_period() * 1e-6;
    device_.times().add_pass(timed.pass, ms);
    all_ms += ms;
  }
  device_.times().waited(waited, all_ms);
}

}  // namespace lichtveld::gpu
