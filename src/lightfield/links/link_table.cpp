#include "links/link_table.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "core/memory.hpp"
#include "lichtveld/gpu/transfer.hpp"

namespace lichtveld::lightfield {

namespace {

// Of the device's memory, links may take: the rest is for images, and for whoever else lives there.
constexpr double most_of_memory = 0.75;
// A word of links that no texel's number equals, of 16 or 32 bits.
constexpr std::uint32_t no_link = 0xffffffffu;

// A rasteriser snaps a chart's corners to 1/256 texel, and a texel's place with them: so far from its record
// [texels].
constexpr float snapped = 1.0f / 128;

gpu::Buffer texels_of(const gpu::Device& device, const TexelRecords& records) {
  std::vector<std::uint32_t> texels;
  texels.reserve(records.count());
  for (const auto& record : records.all()) texels.push_back(record.atlas);
  return gpu::upload<std::uint32_t>(device, "lightfield/texel_of", texels,
                                    vk::BufferUsageFlagBits::eStorageBuffer);
}

gpu::Image numbers_of(const gpu::Device& device, const TexelRecords& records) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(records.source().size());
  for (const auto record : records.source()) numbers.push_back(std::min(record, records.count()));
  gpu::Image image(device, "lightfield/number", {.width = records.size(), .height = records.size()},
                   vk::Format::eR32Uint,
                   vk::ImageUsageFlagBits::eStorage | vk::ImageUsageFlagBits::eTransferDst);
  gpu::fill<std::uint32_t>(device, image, numbers);
  return image;
}

struct Bounds {
  glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};

  void add(const glm::vec3& at, float beside = 0) {
    low = glm::min(low, at - beside);
    high = glm::max(high, at + beside);
  }
  TileBoxes::Tile tile() const { return {(low + high) / 2.0f, (high - low) / 2.0f}; }
};

}  // namespace

LinkTable::LinkTable(const gpu::Device& device, const TexelRecords& records, std::uint32_t pairs,
                     std::uint64_t most_bytes)
    : records(records),
      texels(records.count()),
      pairs(pairs),
      texel_of(texels_of(device, records)),
      number(numbers_of(device, records)) {
  tile = std::clamp(std::bit_floor(device.summary().subgroup_size), 8u, shaders::GROUP);
  // Two values are not texels: a miss, and a link that no pixel tells.
  bits = texels + 1 <= std::numeric_limits<std::uint16_t>::max() && device.summary().storage_16_bit ? 16 : 32;

  const std::uint64_t a_pair = bytes_of(1), all = bytes_of(pairs);
  if (most_bytes > 0)
    require_memory(
        "the links of " + std::to_string(texels) + " texels in " + std::to_string(2 * pairs) + " directions",
        all, most_bytes, "try a smaller --size or --psf, or --method thesis, which keeps none");
  const auto memory = device.summary().memory;
  if (static_cast<double>(all) > most_of_memory * static_cast<double>(memory))
    throw std::runtime_error("the links of " + std::to_string(texels) + " texels in " +
                             std::to_string(2 * pairs) + " directions take " + std::to_string(all >> 20) +
                             " MiB, and " + device.summary().name + " has " + std::to_string(memory >> 20) +
                             " MiB; try a smaller --size or --psf, or --method thesis, which keeps none");
  const auto fit = std::max<std::uint64_t>(2, device.summary().max_storage_buffer / (2 * a_pair) * 2);
  if (2 * a_pair > device.summary().max_storage_buffer)
    throw std::runtime_error(
        "the links of one pair of directions do not fit into one buffer; try a smaller --size");
  for (std::uint32_t first = 0; first < pairs; first += static_cast<std::uint32_t>(fit)) {
    const auto count = std::min(static_cast<std::uint32_t>(fit), pairs - first);
    chunks.push_back(make_chunk(device, "lightfield/links " + std::to_string(chunks.size()), first, count));
  }
}

LinkTable::Chunk LinkTable::make_chunk(const gpu::Device& device, const std::string& name,
                                       std::uint32_t first_pair, std::uint32_t pairs) const {
  Chunk chunk{first_pair, pairs,
              gpu::Buffer(device, name, bytes_of(pairs),
                          vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst)};
  gpu::Frame frame(device);
  frame.clear("route_links", chunk.links, no_link);
  frame.submit_and_wait();
  return chunk;
}

std::uint64_t LinkTable::bytes_of(std::uint32_t pairs) const {
  const std::uint64_t lines = (texels + shaders::LINE - 1) / shaders::LINE;
  return lines * shaders::LINE * pairs * bits / 8;
}

TileBoxes LinkTable::boxes(const scene::Offsets& offsets) const {
  TileBoxes found;
  for (std::uint32_t first = 0; first < texels; first += tile) {
    Bounds bounds;
    for (std::uint32_t index = first; index < std::min(first + tile, texels); ++index)
      bounds.add(records[index].position + offsets[records[index].body], snapped * records[index].side);
    found.tiles.push_back(bounds.tile());
  }
  const auto count = static_cast<std::uint32_t>(found.tiles.size()), each = shaders::GROUP / tile;
  for (std::uint32_t first = 0; first < count; first += each) {
    const auto end = std::min(first + each, count);
    Bounds bounds;
    for (std::uint32_t index = first; index < end; ++index) {
      bounds.add(found.tiles[index].centre - found.tiles[index].half);
      bounds.add(found.tiles[index].centre + found.tiles[index].half);
    }
    found.groups.push_back({bounds.tile(), first, end});
  }
  return found;
}

}  // namespace lichtveld::lightfield
