#include "gather.hpp"

#include <algorithm>

#include "shaders/gather_16.comp.h"
#include "shaders/gather_32.comp.h"
#include "shaders/link_bounce.comp.h"

namespace lichtveld::lightfield {

namespace {

using gpu::Kind;

// Of vectors that shaders fetch at once.
constexpr auto vectors = vk::Format::eR32G32B32A32Sfloat;

gpu::Buffer storage(const gpu::Device& device, const std::string& name, vk::DeviceSize bytes,
                    gpu::Memory where = gpu::Memory::device, vk::Format texels = vk::Format::eUndefined) {
  return {device, name,  bytes, vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst,
          where,  texels};
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

Gather::Gather(const gpu::Device& device, const LinkTable& table, float scale)
    : scale_(scale),
      gather_packed_(gather_pipeline(device, table, 1)),
      gather_full_(gather_pipeline(device, table, 3)),
      end_(device, "gather", link_bounce_comp,
           {.kinds = {Kind::texel_buffer, Kind::storage_buffer, Kind::storage_buffer, Kind::storage_image,
                      Kind::storage_image, Kind::storage_image, Kind::storage_image, Kind::storage_buffer,
                      Kind::storage_buffer, Kind::storage_buffer},
            .push_bytes = sizeof(shaders::BounceConstants)}),
      packed_(storage(device, "lightfield/packed_radiance", (table.texels + 1) * sizeof(std::uint32_t))),
      full_(storage(device, "lightfield/full_radiance", (table.texels + 1) * 3 * sizeof(float))),
      sums_(storage(device, "lightfield/sums", shaders::PARTS * std::uint64_t{table.texels} * sizeof(glm::vec4),
                    gpu::Memory::device, vectors)),
      changes_(storage(device, "lightfield/changes", table.groups() * sizeof(glm::vec2), gpu::Memory::host)) {}

void Gather::start(gpu::Frame& frame, const KeptLinks& links) const {
  frame.clear("gather", packed_);
  frame.clear("gather", full_);
  frame.clear("gather", links.map().total_irradiance, {});
  frame.clear("gather", sums_);
  end(frame, links);
}

void Gather::bounce(gpu::Frame& frame, const KeptLinks& links, Radiance radiance, std::uint32_t first,
                    std::uint32_t parts) const {
  for (std::uint32_t part = first; part < first + parts; ++part)
    gather(frame, links, radiance, part % shaders::PARTS);
  end(frame, links);
}

void Gather::gather(gpu::Frame& frame, const KeptLinks& links, Radiance radiance, std::uint32_t part) const {
  const auto& table = links.table();
  // Parts of whole words of the table.
  const std::uint32_t begin = table.pairs / 2 * part / shaders::PARTS * 2,
                      finish = table.pairs / 2 * (part + 1) / shaders::PARTS * 2;
  bool add = false;
  for (const auto& chunk : table.chunks) {
    const auto first = std::max(begin, chunk.first_pair),
               last = std::min(finish, chunk.first_pair + chunk.pairs);
    if (first >= last) continue;
    frame.compute(radiance == Radiance::packed ? gather_packed_ : gather_full_,
                  {gpu::reads(chunk.links), gpu::reads(radiance == Radiance::packed ? packed_ : full_),
                   gpu::fetches(links.directions()), gpu::reads(table.texel_of), gpu::reads(links.map().normal),
                   gpu::writes(sums_)},
                  shaders::GatherConstants{.texels = table.texels,
                                           .first_pair = chunk.first_pair,
                                           .pairs = chunk.pairs,
                                           .first = first - chunk.first_pair,
                                           .end = last - chunk.first_pair,
                                           .part = part,
                                           .add = add ? 1u : 0u},
                  table.groups(), 1);
    add = true;
  }
}

void Gather::end(gpu::Frame& frame, const KeptLinks& links) const {
  const auto& map = links.map();
  const auto& table = links.table();
  const auto& direct = links.direct();
  frame.compute(
      end_,
      {gpu::fetches(sums_), gpu::reads(direct.sums()), gpu::reads(table.texel_of), gpu::reads(map.albedo),
       gpu::reads(map.emission), gpu::writes(map.total_irradiance), gpu::writes(map.half_difference),
       gpu::writes(packed_), gpu::writes(changes_), gpu::writes(full_)},
      shaders::BounceConstants{.texels = table.texels,
                               .lamps = table.lamp_count(),
                               .radiance_scale = scale_,
                               .direct_scale = direct.scale()},
      table.groups(), 1);
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
