#include "links/gather.hpp"

#include <algorithm>

#include "lichtveld/gpu/transfer.hpp"
#include "shaders/gather_16.comp.h"
#include "shaders/gather_32.comp.h"
#include "shaders/link_bounce.comp.h"
#include "shaders/link_change.comp.h"

namespace lichtveld::lightfield {

namespace {

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
    : device_(device),
      gather_(device, "gather", table.bits == 16 ? shaders::gather_16_comp : shaders::gather_32_comp),
      end_(device, "link_bounce", shaders::link_bounce_comp),
      change_(device, "link_change", shaders::link_change_comp),
      radiance_(dark(device, table)),
      sums_(storage(device, "lightfield/sums",
                    DirectionSet::parts * std::uint64_t{table.texels} * sizeof(glm::vec4), gpu::Memory::device,
                    vectors)),
      groups_(storage(device, "lightfield/gather_groups", sizeof(std::uint32_t), gpu::Memory::host)),
      changed_(storage(device, "lightfield/changed", table.texels * sizeof(glm::vec2))),
      changes_(storage(device, "lightfield/changes", change_groups * sizeof(glm::vec2), gpu::Memory::host)) {}

void Gather::start(gpu::Frame& frame, const KeptLinks& links) const {
  frame.clear("gather", links.map().total_irradiance, {});
  frame.clear("gather", sums_);
  end(frame, links, true);
}

void Gather::bounce(gpu::Frame& frame, const KeptLinks& links) const {
  gather(frame, links, 0, DirectionSet::parts);
  end(frame, links, true);
}

void Gather::part_bounce(gpu::Frame& frame, const KeptLinks& links, std::uint32_t first, std::uint32_t parts) {
  const auto& beside = links.beside();
  gpu::put<std::uint32_t>(device_, groups_, beside);
  gather(frame, links, first, parts);
  if (!beside.empty() && parts < DirectionSet::parts)
    gather(frame, links, first + parts, DirectionSet::parts - parts, static_cast<std::uint32_t>(beside.size()));
  end(frame, links, false);
}

void Gather::gather(gpu::Frame& frame, const KeptLinks& links, std::uint32_t first, std::uint32_t parts,
                    std::optional<std::uint32_t> listed) const {
  const auto& table = links.table();
  for (const auto& chunk : table.chunks)
    frame.compute(
        gather_,
        {gpu::reads("Table", chunk.links), gpu::fetches("radiance", radiance_),
         gpu::fetches("directions", links.directions()), gpu::reads("TexelOf", table.texel_of),
         gpu::reads("normal", links.map().normal), gpu::writes("Sums", sums_), gpu::reads("Groups", groups_)},
        shaders::GatherConstants{.texels = table.texels,
                                 .first_pair = chunk.first_pair,
                                 .pairs = chunk.pairs,
                                 .all_pairs = table.pairs,
                                 .first_part = first,
                                 .parts = parts,
                                 .listed = listed ? 1u : 0u},
        listed.value_or(table.groups()), 1);
}

void Gather::end(gpu::Frame& frame, const KeptLinks& links, bool counted) const {
  const auto& map = links.map();
  const auto& table = links.table();
  const auto& direct = links.direct();
  frame.compute(end_,
                {gpu::fetches("sums", sums_), gpu::reads("Direct", direct.sums()),
                 gpu::reads("Lamps", direct.irradiance()), gpu::reads("TexelOf", table.texel_of),
                 gpu::reads("albedo", map.albedo), gpu::reads("emission", map.emission),
                 gpu::writes("total_irradiance", map.total_irradiance),
                 gpu::writes("half_difference", map.half_difference), gpu::writes("Radiance", radiance_),
                 gpu::writes("Changed", changed_)},
                shaders::BounceConstants{.texels = table.texels,
                                         .lamps = direct.left_out(),
                                         .direct_scale = direct.scale(),
                                         .counted = counted ? 1u : 0u},
                table.groups(), 1);
  if (!counted) return;
  frame.compute(change_, {gpu::reads("Changed", changed_), gpu::writes("Changes", changes_)},
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
