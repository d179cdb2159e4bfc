// The places of a scene that receive light and send it, each with a number. Everything that engines, passes and
// maps know of a texel is kept here, once, on the CPU; a pass that needs it on the device uploads it.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/lamps.hpp"
#include "lichtveld/scene/atlas.hpp"
#include "lichtveld/scene/scene.hpp"
#include "lichtveld/scene/surface_point.hpp"

namespace lichtveld::lightfield {

constexpr std::uint32_t no_record = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t no_atlas_texel = std::numeric_limits<std::uint32_t>::max();

// A place on a surface, bodies at rest.
struct TexelRecord {
  glm::vec3 position;      // [m]
  glm::vec3 normal;        // unit: the interpolated NORMAL, about which light is weighed
  glm::vec3 face;          // unit: the triangle's own, on the same side
  glm::vec3 albedo;        // 0..1, linear: of a texel its mean
  glm::vec3 emission;      // Le [W m^-2 sr^-1]
  float side;              // of a texel there, the longer one [m]
  std::uint32_t triangle;  // of Scene::indices
  std::uint32_t surface;   // of Scene::surfaces, whose chart it lies on
  std::uint32_t body;
  std::uint32_t atlas;  // row * size + column of the texel that it is; no_atlas_texel for what is no texel
};

// What is at a point of a surface, which an atlas of size * size texels shows at `atlas`.
TexelRecord record_at(const scene::Scene& scene, std::uint32_t size, const scene::SurfacePoint& point,
                      std::uint32_t surface, std::uint32_t atlas);

// Of each triangle of Scene::indices.
std::vector<std::uint32_t> surface_of_triangles(const scene::Scene& scene);

// Lamps come first, so that a number tells whether its place is one. Texels follow in blocks of the atlas, so
// that consecutive ones lie together on a surface.
class TexelRecords {
 public:
  // Of the valid texels of an atlas of size * size: scene::valid_texels.
  TexelRecords(const scene::Scene& scene, std::uint32_t size);

  std::uint32_t size() const { return size_; }
  std::uint32_t count() const { return static_cast<std::uint32_t>(records_.size()); }
  const std::vector<TexelRecord>& all() const { return records_; }
  const TexelRecord& operator[](std::uint32_t number) const { return records_[number]; }

  const Lamps& lamps() const { return lamps_; }
  float highest_albedo() const { return highest_albedo_; }  // of all, any channel

  // For each texel of the atlas the record whose light it sends: its own; beside a chart that of the chart's
  // place there (scene::gutter_sources); in what else is a gutter that of the nearest, no_record beyond.
  const std::vector<std::uint32_t>& source() const { return source_; }

 private:
  TexelRecords(const scene::Scene& scene, std::uint32_t size, std::span<const scene::AtlasTexel> texels);

  std::uint32_t size_;
  std::vector<TexelRecord> records_;
  Lamps lamps_;
  float highest_albedo_ = 0;
  std::vector<std::uint32_t> source_;
};

}  // namespace lichtveld::lightfield
