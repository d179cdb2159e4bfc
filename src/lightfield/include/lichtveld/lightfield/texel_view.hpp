// Values of texels or pixels where an engine has them, on the host or on the device.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "lichtveld/gpu/device.hpp"
#include "lichtveld/gpu/resources.hpp"

namespace lichtveld::lightfield {

// Valid as long as its owner leaves them alone.
class TexelView {
 public:
  // `values`: width columns a row, row 0 first.
  TexelView(std::span<const glm::vec4> values, std::uint32_t width) : host_(values), width_(width) {}
  // An image of four 32-bit floats a texel.
  TexelView(const gpu::Device& device, const gpu::Image& image)
      : device_(&device), image_(&image), width_(image.shape().width) {}

  std::uint32_t width() const { return width_; }

  std::vector<glm::vec4> on_host() const;
  // The same without a copy of what is there already; what is not is read back into `room`.
  std::span<const glm::vec4> on_host(std::vector<glm::vec4>& room) const;

 private:
  std::span<const glm::vec4> host_ = {};
  const gpu::Device* device_ = nullptr;
  const gpu::Image* image_ = nullptr;
  std::uint32_t width_;
};

}  // namespace lichtveld::lightfield
