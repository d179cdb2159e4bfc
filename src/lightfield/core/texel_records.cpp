#include "core/texel_records.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "core/texel_albedo.hpp"
#include "lichtveld/scene/gutters.hpp"
#include "shared.h"

namespace lichtveld::lightfield {

std::vector<std::uint32_t> surface_of_triangles(const scene::Scene& scene) {
  std::vector<std::uint32_t> surfaces(scene.indices.size() / 3);
  for (std::uint32_t surface = 0; surface < scene.surfaces.size(); ++surface) {
    const auto first = scene.surfaces[surface].first_index / 3, count = scene.surfaces[surface].index_count / 3;
    std::fill_n(surfaces.begin() + first, count, surface);
  }
  return surfaces;
}

TexelRecord record_at(const scene::Scene& scene, std::uint32_t size, const scene::SurfacePoint& point,
                      std::uint32_t surface_index, std::uint32_t atlas) {
  const auto& surface = scene.surfaces[surface_index];
  const auto& material = scene.materials[surface.material];
  const auto corner = [&](std::size_t k) -> const scene::Vertex& {
    return scene.vertices[scene.indices[std::size_t{3} * point.triangle + k]];
  };
  const scene::Vertex &a = corner(0), &b = corner(1), &c = corner(2);
  const glm::vec3 w = scene::weights(point);
  const glm::vec3 cross = glm::cross(b.position - a.position, c.position - a.position);
  const glm::vec3 face = glm::length(cross) > 0 ? glm::normalize(cross) : glm::vec3(0);
  // As a difference, so that corners that are alike give all places the same, to the last bit.
  const glm::vec3 normal = a.normal + w.y * (b.normal - a.normal) + w.z * (c.normal - a.normal);
  const glm::vec3 facing = glm::dot(face, normal) < 0 ? -face : face;
  const float length = glm::length(normal);
  // Metres a texel along the atlas' u and v: the triangle's edges are these times the edges of its chart.
  const glm::mat2 chart(b.atlas - a.atlas, c.atlas - a.atlas);
  const glm::mat2x3 along = glm::mat2x3(b.position - a.position, c.position - a.position) * glm::inverse(chart);
  return {.position = w.x * a.position + w.y * b.position + w.z * c.position,
          .normal = length > 0 ? normal / length : facing,
          .face = facing,
          .albedo = scene::albedo_at(scene, material, point),
          .emission = material.emission,
          .side = std::max(glm::length(along[0]), glm::length(along[1])) / static_cast<float>(size),
          .triangle = point.triangle,
          .surface = surface_index,
          .body = surface.body,
          .atlas = atlas};
}

namespace {

// Atlas texels a side of a block that is numbered together.
constexpr std::uint32_t block = 8;

// Calls each(atlas texel): block by block, within a block in Morton order, so that any run of numbers is nearly
// square.
template <typename Each>
void in_blocks(std::uint32_t size, const Each& each) {
  for (std::uint32_t top = 0; top < size; top += block)
    for (std::uint32_t left = 0; left < size; left += block)
      for (std::uint32_t code = 0; code < block * block; ++code) {
        const std::uint32_t x = left + (code & 1) + (code >> 1 & 2) + (code >> 2 & 4),
                            y = top + (code >> 1 & 1) + (code >> 2 & 2) + (code >> 3 & 4);
        if (x < size && y < size) each(y * size + x);
      }
}

std::vector<TexelRecord> records_of(const scene::Scene& scene, std::uint32_t size,
                                    std::span<const scene::AtlasTexel> texels) {
  const auto surfaces = surface_of_triangles(scene);
  const auto emission_of = [&](const scene::AtlasTexel& texel) -> const glm::vec3& {
    return scene.materials[scene.surfaces[surfaces[texel.at.triangle]].material].emission;
  };
  float brightest = 0;
  std::vector<std::uint32_t> at(std::size_t{size} * size, no_record);
  for (std::uint32_t index = 0; index < texels.size(); ++index) {
    brightest = std::max(brightest, Lamps::strength(emission_of(texels[index])));
    at[texels[index].index] = index;
  }
  std::vector<TexelRecord> records;
  records.reserve(texels.size());
  for (const bool lamps : {true, false})
    in_blocks(size, [&](std::uint32_t atlas) {
      if (at[atlas] == no_record) return;
      const auto& texel = texels[at[atlas]];
      if (Lamps::is_lamp(emission_of(texel), brightest) == lamps)
        records.push_back(record_at(scene, size, texel.at, surfaces[texel.at.triangle], texel.index));
    });
  average_albedo(scene, size, records);
  return records;
}

Lamps lamps_of(const std::vector<TexelRecord>& records) {
  float brightest = 0;
  for (const auto& record : records) brightest = std::max(brightest, Lamps::strength(record.emission));
  std::vector<glm::vec3> emission;
  for (const auto& record : records) {
    if (!Lamps::is_lamp(record.emission, brightest)) break;
    emission.push_back(record.emission);
  }
  return {std::move(emission), brightest};
}

// The nearest of `own` around an atlas texel that has none, within the gutter's width.
std::uint32_t nearest(const std::vector<std::uint32_t>& own, std::uint32_t size, int x, int y) {
  const int side = static_cast<int>(size);
  std::uint32_t found = no_record;
  int best = std::numeric_limits<int>::max();
  for (int dy = -shaders::GUTTER; dy <= shaders::GUTTER; ++dy)
    for (int dx = -shaders::GUTTER; dx <= shaders::GUTTER; ++dx) {
      const int u = x + dx, v = y + dy, distance_squared = dx * dx + dy * dy;
      if (distance_squared >= best || u < 0 || v < 0 || u >= side || v >= side) continue;
      const auto record = own[static_cast<std::size_t>(v) * size + static_cast<std::size_t>(u)];
      if (record == no_record) continue;
      best = distance_squared;
      found = record;
    }
  return found;
}

// Beside charts what belongs there, farther off the nearest.
std::vector<std::uint32_t> sources_of(const scene::Scene& scene, std::span<const scene::AtlasTexel> texels,
                                      const std::vector<TexelRecord>& records, std::uint32_t size) {
  std::vector<std::uint32_t> own(std::size_t{size} * size, no_record);
  for (std::uint32_t number = 0; number < records.size(); ++number) own[records[number].atlas] = number;
  const auto belongs = scene::gutter_sources(scene, size, texels);
  std::vector<std::uint32_t> source;
  for (std::uint32_t atlas = 0; atlas < own.size(); ++atlas)
    source.push_back(belongs[atlas] != scene::no_texel
                         ? own[belongs[atlas]]
                         : nearest(own, size, static_cast<int>(atlas % size), static_cast<int>(atlas / size)));
  return source;
}

}  // namespace

TexelRecords::TexelRecords(const scene::Scene& scene, std::uint32_t size)
    : TexelRecords(scene, size, scene::valid_texels(scene, size)) {}

TexelRecords::TexelRecords(const scene::Scene& scene, std::uint32_t size,
                           std::span<const scene::AtlasTexel> texels)
    : size_(size),
      records_(records_of(scene, size, texels)),
      lamps_(lamps_of(records_)),
      source_(sources_of(scene, texels, records_, size)) {
  for (const auto& record : records_)
    highest_albedo_ = std::max({highest_albedo_, record.albedo.r, record.albedo.g, record.albedo.b});
}

}  // namespace lichtveld::lightfield
