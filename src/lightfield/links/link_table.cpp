#include "links/link_table.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace lichtveld::lightfield {

namespace {

// Atlas texels a side of a block that is numbered together: as many as a tile has, where all are valid.
constexpr std::uint32_t block = 8;
// Of the device's memory, links may take: the rest is for images, and for whoever else lives there.
constexpr double most_of_memory = 0.75;
// A word of links that no texel's number equals, of 16 or 32 bits.
constexpr std::uint32_t no_link = 0xffffffffu;

// What emits less than this share of the brightest is no lamp: the whole numbers that direct light is summed in
// would not tell its shades. A bounce gathers its light with what surfaces reflect.
constexpr float dimmest_lamp = 1e-4f;

// Within a block in Morton order, so that any run of numbers is nearly square.
std::vector<std::uint32_t> valid_texels(const std::vector<glm::vec4>& positions, std::uint32_t size) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t top = 0; top < size; top += block)
    for (std::uint32_t left = 0; left < size; left += block)
      for (std::uint32_t code = 0; code < block * block; ++code) {
        const std::uint32_t x = left + (code & 1) + (code >> 1 & 2) + (code >> 2 & 4),
                            y = top + (code >> 1 & 1) + (code >> 2 & 2) + (code >> 3 & 4);
        if (x < size && y < size && positions[std::size_t{y} * size + x].a > 0) found.push_back(y * size + x);
      }
  return found;
}

float most_of(const glm::vec4& emission) {
  return std::max({emission.r, emission.g, emission.b});
}

// Moves the lamps to the front and returns what each sends.
std::vector<glm::vec3> lamps_first(std::vector<std::uint32_t>& valid, const std::vector<glm::vec4>& emission,
                                   float brightest) {
  const auto end = std::stable_partition(valid.begin(), valid.end(), [&](std::uint32_t texel) {
    return most_of(emission[texel]) > dimmest_lamp * brightest;
  });
  std::vector<glm::vec3> lamps;
  for (auto texel = valid.begin(); texel != end; ++texel) lamps.emplace_back(emission[*texel]);
  return lamps;
}

std::vector<std::uint32_t> body_of_triangles(const scene::Scene& scene) {
  std::vector<std::uint32_t> bodies;
  for (std::size_t corner = 0; corner < scene.indices.size(); corner += 3)
    bodies.push_back(scene.vertices[scene.indices[corner]].body);
  return bodies;
}

gpu::Image numbers(const gpu::Device& device, const LightMap& map, const std::vector<std::uint32_t>& texels) {
  auto source = gpu::download<std::uint32_t>(device, map.source);
  const auto none = static_cast<std::uint32_t>(texels.size());
  std::vector<std::uint32_t> number(source.size(), none);
  for (std::uint32_t index = 0; index < none; ++index) number[texels[index]] = index;
  for (auto& from : source) from = from == shaders::NO_TEXEL ? none : number[from];
  const auto staging = gpu::upload<std::uint32_t>(device, "lightfield/number (upload)", source,
                                                  vk::BufferUsageFlagBits::eTransferSrc);
  gpu::Image image(device, "lightfield/number", {.width = map.size, .height = map.size}, vk::Format::eR32Uint,
                   vk::ImageUsageFlagBits::eStorage | vk::ImageUsageFlagBits::eTransferDst);
  gpu::PassTimes times;
  gpu::Frame frame(device, times);
  frame.copy("number the texels", staging, image);
  frame.submit_and_wait();
  return image;
}

struct Bounds {
  glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};

  void add(const glm::vec3& place) {
    low = glm::min(low, place);
    high = glm::max(high, place);
  }
  TileBoxes::Tile tile() const { return {(low + high) / 2.0f, (high - low) / 2.0f}; }
};

}  // namespace

LinkTable::LinkTable(const gpu::Device& device, const scene::Scene& scene, const LightMap& map,
                     std::uint32_t pairs)
    : pairs(pairs),
      texel_of(device, "lightfield/texel_of", sizeof(std::uint32_t), vk::BufferUsageFlagBits::eStorageBuffer),
      number(device, "lightfield/number", {}, vk::Format::eR32Uint, vk::ImageUsageFlagBits::eStorage) {
  const auto positions = gpu::download<glm::vec4>(device, map.position);
  const auto faces = gpu::download<glm::vec4>(device, map.face_normal);
  auto valid = valid_texels(positions, map.size);
  const auto emission = gpu::download<glm::vec4>(device, map.emission);
  for (const auto texel : valid) brightest = std::max(brightest, most_of(emission[texel]));
  lamps = lamps_first(valid, emission, brightest);
  while (lamps_alike < lamps.size() && lamps[lamps_alike] == lamps[0]) ++lamps_alike;
  const auto bodies = body_of_triangles(scene);
  texels = static_cast<std::uint32_t>(valid.size());
  tile = std::clamp(std::bit_floor(device.summary().subgroup_size), 8u, shaders::TILE);
  for (const auto texel : valid)
    places_.push_back({glm::vec3(positions[texel]), bodies[static_cast<std::size_t>(faces[texel].a)]});
  // Two values are not texels: a miss, and a link that no pixel tells.
  bits = texels + 1 <= std::numeric_limits<std::uint16_t>::max() && device.summary().storage_16_bit ? 16 : 32;

  const std::uint64_t a_pair = bytes_of(1), all = bytes_of(pairs);
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
  texel_of =
      gpu::upload<std::uint32_t>(device, "lightfield/texel_of", valid, vk::BufferUsageFlagBits::eStorageBuffer);
  number = numbers(device, map, valid);
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
  gpu::PassTimes times;
  gpu::Frame frame(device, times);
  frame.clear("route_links", chunk.links, no_link);
  frame.submit_and_wait();
  return chunk;
}

std::uint64_t LinkTable::bytes_of(std::uint32_t pairs) const {
  const std::uint64_t lines = (texels + shaders::LINE - 1) / shaders::LINE;
  return lines * shaders::LINE * pairs * bits / 8;
}

TileBoxes LinkTable::boxes(const std::vector<glm::vec3>& offsets) const {
  TileBoxes found;
  for (std::uint32_t first = 0; first < texels; first += tile) {
    Bounds bounds;
    for (std::uint32_t index = first; index < std::min(first + tile, texels); ++index)
      bounds.add(places_[index].at_rest + offsets[places_[index].body]);
    found.tiles.push_back(bounds.tile());
  }
  const auto count = static_cast<std::uint32_t>(found.tiles.size()), each = shaders::TILE / tile;
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
