#include "gather.hpp"

#include <algorithm>

#include "shaders/gather_16.comp.h"
#include "shaders/gather_32.comp.h"
#include "shaders/link_bounce.comp.h"
#include "shaders/link_change.comp.h"

namespace lichtveld::lightfield {

namespace {

using gpu::Kind;

// Workgroups that go through all texels for what a bounce has changed.
constexpr std::uint32_t change_groups = 64;
// Of vectors that shaders fetch at once.
constexpr auto vectors = vk::Format::eR32G32B32A32Sfloat;

gpu::Buffer storage(const gpu::Device& device, const std::string& name, vk::DeviceSize bytes,
                    gpu::Memory where = gpu::Memory::device, vk::Format texels = vk::Format::eUndefined) {
  return {device, name,  bytes, vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst,
          where,  texels};
}

// Before the first bounce. What sees nothing receives no light from there, what is not known is left out.
gpu::Buffer dark(const gpu::Device& device, const LinkTable& table) {
  std::vector radiance(table.texels + 2, glm::vec4(0));
  radiance[table.texels].a = 1;
  return gpu::upload<glm::vec4>(device, "lightfield/linked_radiance", radiance,
                                vk::BufferUsageFlagBits::eStorageBuffer, vectors);
}

}  // namespace

Gather::Gather(const gpu::Device& device, const LinkTable& table)
    : gather_(device, "gather", table.bits == 16 ? gpu::Spirv(gather_16_comp) : gpu::Spirv(gather_32_comp),
              {.kinds = {Kind::storage_buffer, Kind::texel_buffer, Kind::texel_buffer, Kind::storage_buffer,
                         Kind::storage_image, Kind::storage_buffer},
               .push_bytes = sizeof(shaders::GatherConstants)}),
      end_(device, "gather", link_bounce_comp,
           {.kinds = {Kind::texel_buffer, Kind::storage_buffer, Kind::storage_buffer, Kind::storage_image,
                      Kind::storage_image, Kind::storage_image, Kind::storage_image, Kind::storage_buffer,
                      Kind::storage_buffer},
            .push_bytes = sizeof(shaders::BounceConstants)}),
      change_(device, "gather", link_change_comp,
              {.kinds = std::vector(2, Kind::storage_buffer), .push_bytes = sizeof(shaders::ChangeConstants)}),
      radiance_(dark(device, table)),
      sums_(storage(device, "lightfield/sums", shaders::PARTS * std::uint64_t{table.texels} * sizeof(glm::vec4),
                    gpu::Memory::device, vectors)),
      changed_(storage(device, "lightfield/changed", table.texels * sizeof(glm::vec2))),
      changes_(storage(device, "lightfield/changes", change_groups * sizeof(glm::vec2), gpu::Memory::host)) {}

void Gather::start(gpu::Frame& frame, const KeptLinks& links) const {
  frame.clear("gather", links.map().total_irradiance, {});
  frame.clear("gather", sums_);
  end(frame, links, false);
}

void Gather::bounce(gpu::Frame& frame, const KeptLinks& links) const {
  for (std::uint32_t part = 0; part < shaders::PARTS; ++part) gather(frame, links, part);
  end(frame, links, true);
}

void Gather::part_bounce(gpu::Frame& frame, const KeptLinks& links, std::uint32_t first,
                         std::uint32_t parts) const {
  for (std::uint32_t part = first; part < first + parts; ++part) gather(frame, links, part % shaders::PARTS);
  end(frame, links, false);
}

void Gather::gather(gpu::Frame& frame, const KeptLinks& links, std::uint32_t part) const {
  const auto& table = links.table();
  // Parts of whole words of the table.
  const std::uint32_t begin = table.pairs / 2 * part / shaders::PARTS * 2,
                      finish = table.pairs / 2 * (part + 1) / shaders::PARTS * 2;
  bool add = false;
  for (const auto& chunk : table.chunks) {
    const auto first = std::max(begin, chunk.first_pair),
               last = std::min(finish, chunk.first_pair + chunk.pairs);
    if (first >= last) continue;
    frame.compute(gather_,
                  {gpu::reads(chunk.links), gpu::fetches(radiance_), gpu::fetches(links.directions()),
                   gpu::reads(table.texel_of), gpu::reads(links.map().normal), gpu::writes(sums_)},
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

void Gather::end(gpu::Frame& frame, const KeptLinks& links, bool counted) const {
  const auto& map = links.map();
  const auto& table = links.table();
  const auto& direct = links.direct();
  frame.compute(end_,
                {gpu::fetches(sums_), gpu::reads(direct.sums()), gpu::reads(table.texel_of),
                 gpu::reads(map.albedo), gpu::reads(map.emission), gpu::writes(map.total_irradiance),
                 gpu::writes(map.half_difference), gpu::writes(radiance_), gpu::writes(changed_)},
                shaders::BounceConstants{.texels = table.texels,
                                         .lamps = table.lamp_count(),
                                         .direct_scale = direct.scale(),
                                         .counted = counted ? 1u : 0u},
                table.groups(), 1);
  if (!counted) return;
  frame.compute(change_, {gpu::reads(changed_), gpu::writes(changes_)},
                shaders::ChangeConstants{.texels = table.texels}, change_groups, 1);
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
