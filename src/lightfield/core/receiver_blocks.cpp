#include "core/receiver_blocks.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace lichtveld::lightfield {

namespace {

// Receivers of one block are in one square of so many texels a side of the atlas, and at most so far from its
// first [its sides].
constexpr std::uint32_t block_side = 4;
constexpr float block_reach = 8;

}  // namespace

ReceiverBlocks::ReceiverBlocks(std::span<const TexelRecord> receivers, std::uint32_t bodies, std::uint32_t size)
    : order_(receivers.size()), of_body_(bodies) {
  const auto square = [&](std::uint32_t receiver) {
    const auto& record = receivers[receiver];
    return std::array{record.body, record.atlas / size / block_side, record.atlas % size / block_side};
  };
  std::iota(order_.begin(), order_.end(), 0u);
  std::ranges::stable_sort(order_, {}, square);
  for (std::uint32_t i = 0; i < order_.size(); ++i) {
    const auto& record = receivers[order_[i]];
    const auto belongs_to = [&](const Block& block) {
      const std::uint32_t first = order_[block.first];
      return block.size() < most_receivers && square(first) == square(order_[i]) &&
             glm::distance(receivers[first].position, record.position) <= block_reach * record.side;
    };
    if (blocks_.empty() || !belongs_to(blocks_.back())) {
      Range& of_body = of_body_[record.body];
      if (of_body.size() == 0) of_body.first = static_cast<std::uint32_t>(blocks_.size());
      blocks_.push_back({{i, i}, {record.position, record.position}});
      of_body.end = static_cast<std::uint32_t>(blocks_.size());
    }
    Block& block = blocks_.back();
    block.end = i + 1;
    block.box = {glm::min(block.box.min, record.position), glm::max(block.box.max, record.position)};
  }
  find_neighbours(receivers, size);
}

void ReceiverBlocks::find_neighbours(std::span<const TexelRecord> receivers, std::uint32_t size) {
  const auto first = [&](std::uint32_t block) -> const TexelRecord& {
    return receivers[order_[blocks_[block].first]];
  };
  const std::uint32_t squares = (size + block_side - 1) / block_side;
  std::vector<std::vector<std::uint32_t>> in_square(std::size_t{squares} * squares);
  const auto square = [&](std::uint32_t block) {
    const std::uint32_t atlas = first(block).atlas;
    return std::pair{static_cast<int>(atlas % size / block_side), static_cast<int>(atlas / size / block_side)};
  };
  const auto at = [&](int x, int y) -> std::vector<std::uint32_t>* {
    const auto side = static_cast<int>(squares);
    if (x < 0 || y < 0 || x >= side || y >= side) return nullptr;
    return &in_square[static_cast<std::size_t>(y * side + x)];
  };
  beside_.resize(count());
  for (std::uint32_t block = 0; block < count(); ++block)
    if (first(block).atlas != no_atlas_texel) at(square(block).first, square(block).second)->push_back(block);
  for (std::uint32_t block = 0; block < count(); ++block) {
    if (first(block).atlas == no_atlas_texel) continue;
    const auto [x, y] = square(block);
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (const auto* there = at(x + dx, y + dy))
          for (const auto other : *there)
            if (other != block && first(other).body == first(block).body &&
                glm::distance(first(other).position, first(block).position) <= block_reach * first(block).side)
              beside_[block].push_back(other);
  }
}

}  // namespace lichtveld::lightfield
