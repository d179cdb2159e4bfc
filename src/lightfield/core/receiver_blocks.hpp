// Up to 16 receivers that lie near each other on the atlas and in space, and are of one body: they see much the
// same, so that what one of them finds tells what the others need not look for.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/texel_records.hpp"
#include "lichtveld/lightfield/directions.hpp"
#include "lichtveld/scene/scene.hpp"

namespace lichtveld::lightfield {

class ReceiverBlocks {
 public:
  static constexpr std::uint32_t most_receivers = 16;  // of a block

  struct Block : Range {  // of those that follow each other in the blocks' order
    scene::Box box = {};  // around their places, bodies at rest [m]
  };

  // Of receivers on an atlas of size * size texels.
  ReceiverBlocks(std::span<const TexelRecord> receivers, std::uint32_t bodies, std::uint32_t size);

  std::uint32_t count() const { return static_cast<std::uint32_t>(blocks_.size()); }
  const Block& operator[](std::uint32_t block) const { return blocks_[block]; }
  const Range& of_body(std::uint32_t body) const { return of_body_[body]; }
  // The numbers of a block's receivers, and of those of blocks, of which there are some.
  std::uint32_t receiver(const Block& block, std::uint32_t i) const { return order_[block.first + i]; }
  std::span<const std::uint32_t> receivers(const Range& blocks) const {
    return {order_.data() + blocks_[blocks.first].first, order_.data() + blocks_[blocks.end - 1].end};
  }
  // Those around a block.
  std::span<const std::uint32_t> beside(std::uint32_t block) const { return beside_[block]; }

 private:
  void find_neighbours(std::span<const TexelRecord> receivers, std::uint32_t size);

  std::vector<std::uint32_t> order_;  // body by body
  std::vector<Block> blocks_;
  std::vector<Range> of_body_;
  std::vector<std::vector<std::uint32_t>> beside_;
};

}  // namespace lichtveld::lightfield
