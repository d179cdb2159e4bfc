#include "lichtveld/lightfield/texel_view.hpp"

#include "lichtveld/gpu/transfer.hpp"

namespace lichtveld::lightfield {

std::vector<glm::vec4> TexelView::on_host() const {
  if (image_ != nullptr) return gpu::download<glm::vec4>(*device_, *image_);
  return {host_.begin(), host_.end()};
}

std::span<const glm::vec4> TexelView::on_host(std::vector<glm::vec4>& room) const {
  if (image_ == nullptr) return host_;
  room = on_host();
  return room;
}

}  // namespace lichtveld::lightfield
