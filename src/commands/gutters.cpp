#include "gutters.hpp"

#include <algorithm>
#include <vector>

#include "lichtveld/scene/gutters.hpp"

namespace lichtveld::commands {

Gutters::Gutters(const scene::Scene& scene, std::uint32_t size)
    : size_(size), source_(scene::gutter_sources(scene, size, scene::valid_texels(scene, size))) {}

void Gutters::fill(std::span<glm::vec4> texels) const {
  for (std::uint32_t i = 0; i < texels.size(); ++i)
    if (texels[i] == glm::vec4(0) && source_[i] != scene::no_texel)
      texels[i] = glm::vec4(glm::vec3(texels[source_[i]]), 0);
  const auto n = static_cast<std::int64_t>(size_);
  std::vector<bool> has_value(texels.size());
  std::vector<std::uint32_t> ring;  // texels without one that may get it next
  const auto for_neighbours = [&](std::uint32_t index, const auto& each) {
    const std::int64_t x = index % size_, y = index / size_;
    for (std::int64_t v = std::max<std::int64_t>(y - 1, 0); v <= std::min(y + 1, n - 1); ++v)
      for (std::int64_t u = std::max<std::int64_t>(x - 1, 0); u <= std::min(x + 1, n - 1); ++u)
        each(static_cast<std::uint32_t>(v * n + u));
  };
  for (std::uint32_t i = 0; i < texels.size(); ++i)
    has_value[i] = texels[i] != glm::vec4(0) || source_[i] != scene::no_texel;
  std::vector<bool> is_open(texels.size());
  const auto open_around = [&](std::uint32_t index) {
    for_neighbours(index, [&](std::uint32_t other) {
      if (has_value[other] || is_open[other]) return;
      is_open[other] = true;
      ring.push_back(other);
    });
  };
  for (std::uint32_t i = 0; i < texels.size(); ++i)
    if (has_value[i]) open_around(i);
  while (!ring.empty()) {
    const auto filled = std::move(ring);
    ring.clear();
    for (const auto index : filled) {
      glm::vec4 sum(0);
      for_neighbours(index, [&](std::uint32_t other) {
        if (has_value[other]) sum += glm::vec4(glm::vec3(texels[other]), 1);
      });
      texels[index] = glm::vec4(glm::vec3(sum) / sum.a, 0);
    }
    for (const auto index : filled) has_value[index] = true;
    for (const auto index : filled) open_around(index);
  }
}

}  // namespace lichtveld::commands
