// direct_light: the light that comes straight from lamps, in either of two ways. Exact: of each texel, by
// core/lamp_light.hpp; links see what reflects alone. By the directions: kept by changed links, for each texel
// and half of the directions the sum of w Le over the lamps that it sees. A link that is replaced takes its
// share off and adds the new one's (relink.glsl). The sums are whole numbers: whatever comes and goes, they are
// those of the links as they are.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/lamp_light.hpp"
#include "lichtveld/gpu/frame.hpp"
#include "links/link_table.hpp"
#include "passes/light_map.hpp"

namespace lichtveld::lightfield {

class DirectLight {
 public:
  // Of a table that links nothing yet. All of these must outlive it.
  DirectLight(const gpu::Device& device, const scene::Scene& scene, const LinkTable& table, Direct way);

  // Exact: as LampLight::light. Otherwise links tell.
  void light(const scene::Offsets& offsets, const scene::Scales& scales, const Moves& moves);

  // By the directions: sums it up afresh. `directions`: vec4 a pair: xyz; w:
  // solid angle [sr]. Costs links: a load of half a word each.
  void sum(gpu::Frame& frame, const LightMap& map, const LinkTable& table, const gpu::Buffer& directions) const;

  bool is_exact() const { return exact_.has_value(); }
  // Lamps of TexelRecords that links count, from the first on; and those whose Le no bounce gathers.
  std::uint32_t linked_lamps() const { return is_exact() ? 0 : records_.lamps().count(); }
  std::uint32_t left_out() const { return is_exact() ? records_.count() : linked_lamps(); }
  // vec4 a texel: E straight from lamps, if it is exact [W m^-2]; 0 otherwise.
  const gpu::Buffer& irradiance() const { return irradiance_; }
  // Of exact light, that of each texel of the atlas: LampLight::half_difference.
  void add_half_difference(std::span<glm::vec4> atlas) const;
  float scale() const { return scale_; }               // of the sums: w Le [W m^-2] times this
  const gpu::Buffer& lamps() const { return lamps_; }  // float: Le of each lamp, three channels, times scale
  const gpu::Buffer& sums() const { return sums_; }    // uint: of each texel and half, three channels

 private:
  const gpu::Device& device_;
  const TexelRecords& records_;
  std::unique_ptr<const scene::RayIndex> index_;
  std::optional<LampLight> exact_;
  gpu::ComputePipeline sum_;
  float scale_;
  gpu::Buffer lamps_, sums_;
  gpu::Buffer irradiance_;  // host-visible
};

}  // namespace lichtveld::lightfield
