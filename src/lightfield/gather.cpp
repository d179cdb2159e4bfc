#include "gather.hpp"

#include <algorithm>

#include "shaders/gather_16.comp.h"
#include "shaders/gather_32.comp.h"
#include "shaders/link_bounce.comp.h"

namespace lichtveld::lightfield {

namespace {

using gpu::Kind;

gpu::Buffer storage(const gpu::Device& device, const std::string& name, vk::DeviceSize bytes,
                    gpu::Memory where = gpu::Memory::device) {
  return {device, name, bytes, vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst,
          where};
}

std::vector<glm::vec4> pair_directions(const std::vector<Direction>& directions) {
  std::vector<glm::vec4> pairs;
  for (std::size_t pair = 0; pair < directions.size() / 2; ++pair)
    pairs.emplace_back(directions[pair].along, directions[pair].solid_angle);
  return pairs;
}

gpu::ComputePipeline gather_pipeline(const gpu::Device& device, const LinkTable& table, std::uint32_t words) {
  return {device,
          "gather",
          table.bits == 16 ? gpu::Spirv(gather_16_comp) : gpu::Spirv(gather_32_comp),
          {.kinds = {Kind::storage_buffer, Kind::storage_buffer, Kind::texel_buffer, Kind::storage_buffer,
                     Kind::storage_image, Kind::storage_buffer},
           .push_bytes = sizeof(shaders::GatherConstants),
           .specialisation = {words}}};
}

}  // namespace

Gather::Gather(const gpu::Device& device, const LinkTable& table, const std::vector<Direction>& directions,
               float scale)
    : pairs_(static_cast<std::uint32_t>(directions.size() / 2)),
      scale_(scale),
      gather_packed_(gather_pipeline(device, table, 1)),
      gather_full_(gather_pipeline(device, table, 3)),
      end_(device, "gather", link_bounce_comp,
           {.kinds = {Kind::storage_buffer, Kind::storage_buffer, Kind::storage_buffer, Kind::storage_image,
                      Kind::storage_image, Kind::storage_image, Kind::storage_image, Kind::storage_buffer,
                      Kind::storage_buffer, Kind::storage_buffer},
            .push_bytes = sizeof(shaders::BounceConstants)}),
      packed_(storage(device, "lightfield/packed_radiance", (table.texels + 1) * sizeof(std::uint32_t))),
      full_(storage(device, "lightfield/full_radiance", (table.texels + 1) * 3 * sizeof(float))),
      directions_(gpu::upload<glm::vec4>(device, "lightfield/pair_directions", pair_directions(directions),
                                         vk::BufferUsageFlagBits::eStorageBuffer,
                                         vk::Format::eR32G32B32A32Sfloat)),
      sums_{storage(device, "lightfield/sums 0", table.texels * sizeof(glm::vec4)),
            storage(device, "lightfield/sums 1", table.texels * sizeof(glm::vec4))},
      changes_(storage(device, "lightfield/changes", table.groups() * sizeof(glm::vec2), gpu::Memory::host)) {}

void Gather::start(gpu::Frame& frame, const LightMap& map, const LinkTable& table) const {
  frame.clear("gather", packed_);
  frame.clear("gather", full_);
  frame.clear("gather", map.total_irradiance, {});
  for (const auto& sum : sums_) frame.clear("gather", sum);
  end(frame, map, table);
}

void Gather::bounce(gpu::Frame& frame, const LightMap& map, const LinkTable& table, Radiance radiance,
                    std::initializer_list<std::uint32_t> halves) const {
  for (const auto half : halves) {
    const std::uint32_t begin = half * pairs_ / 2, finish = begin + pairs_ / 2;
    bool add = false;
    for (const auto& chunk : table.chunks) {
      const auto first = std::max(begin, chunk.first_pair),
                 last = std::min(finish, chunk.first_pair + chunk.pairs);
      if (first >= last) continue;
      frame.compute(radiance == Radiance::packed ? gather_packed_ : gather_full_,
                    {gpu::reads(chunk.links), gpu::reads(radiance == Radiance::packed ? packed_ : full_),
                     gpu::fetches(directions_), gpu::reads(table.texel_of), gpu::reads(map.normal),
                     gpu::writes(sums_[half])},
                    shaders::GatherConstants{.texels = table.texels,
                                             .first_pair = chunk.first_pair,
                                             .pairs = chunk.pairs,
                                             .first = first - chunk.first_pair,
                                             .end = last - chunk.first_pair,
                                             .add = add ? 1u : 0u},
                    table.groups(), 1);
      add = true;
    }
  }
  end(frame, map, table);
}

void Gather::end(gpu::Frame& frame, const LightMap& map, const LinkTable& table) const {
  frame.compute(end_,
                {gpu::reads(sums_[0]), gpu::reads(sums_[1]), gpu::reads(table.texel_of), gpu::reads(map.albedo),
                 gpu::reads(map.emission), gpu::writes(map.total_irradiance), gpu::writes(map.half_difference),
                 gpu::writes(packed_), gpu::writes(changes_), gpu::writes(full_)},
                shaders::BounceConstants{.texels = table.texels, .radiance_scale = scale_}, table.groups(), 1);
  frame.to_host(changes_);
}

Gather::Change Gather::change(const LinkTable& table) const {
  Change found{};
  for (const auto& tile : changes_.as<glm::vec2>()) {
    found.most = std::max(found.most, double{tile.x});
    found.mean += tile.y;
  }
  found.mean /= 3.0 * table.texels;
  return found;
}

}  // namespace lichtveld::lightfield
