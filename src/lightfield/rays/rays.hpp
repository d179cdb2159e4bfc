// The engine `rays`: what each texel sees is found by rays, on the CPU, and kept. Light straight from lamps is
// exact; what surfaces reflect is a sum over kept links, averaged over the sets of directions of neighbouring
// texels.
#pragma once

#include "core/lamp_light.hpp"
#include "lichtveld/gpu/resources.hpp"
#include "lichtveld/lightfield/light_field.hpp"
#include "lichtveld/lightfield/settings.hpp"
#include "lichtveld/scene/ray_index.hpp"
#include "passes/presenter.hpp"
#include "rays/block_filter.hpp"
#include "rays/ray_gather.hpp"
#include "rays/ray_links.hpp"
#include "rays/ray_sets.hpp"
#include "rays/rows.hpp"

namespace lichtveld::lightfield {

class Rays final : public LightField {
 public:
  Rays(const gpu::Device& device, const scene::Scene& scene, const Settings& settings);

  TexelView irradiance_view() const override { return {irradiance_, settings_.size}; }
  Shown shown(const Adaptation& adaptation) override;
  gpu::Times times() const override { return device_.times().so_far() - begun_; }

 private:
  bool compute(Light before, const Moves& moves, const Enough& enough, Solution& solution) override;
  double error_estimate() const override;

  std::vector<char> hidden() const;
  std::uint64_t bytes() const;
  void link(const Moves& moves, Solution& solution);
  bool converge(Light before, const Enough& enough, Solution& solution);
  void bounce(Solution& solution);
  void count_rays(Solution& solution) const;
  void finish();

  const gpu::Device& device_;
  const gpu::Times begun_;  // Device::times() before it all
  const scene::Scene& scene_;
  const Settings settings_;
  const TexelRecords records_;
  const std::unique_ptr<const scene::RayIndex> index_;
  const Rows rows_;
  const gpu::LedgerEntry memory_;  // of all that follows; before any of it is taken
  const RaySets sets_;
  RayLinks links_;
  BlockFilter filter_;
  const std::vector<std::uint32_t> sample_sets_;  // of rows
  LampLight lamps_;
  RayGather gather_;
  std::vector<glm::vec4> averages_;    // what rows have gathered, over their blocks [W m^-2]
  std::vector<glm::vec4> irradiance_;  // of the atlas
  std::optional<Presenter> presenter_;
};

}  // namespace lichtveld::lightfield
