// The engine `links`: for every pair of directions and every texel the texel that it sees is found once and
// kept. A bounce is a sum over kept links; a moved body re-routes only what its old and its new projections
// touch.
#pragma once

#include "lichtveld/lightfield/light_field.hpp"
#include "lichtveld/lightfield/settings.hpp"
#include "links/gather.hpp"
#include "links/kept_links.hpp"
#include "passes/brdf.hpp"
#include "passes/over.hpp"
#include "passes/tone_map.hpp"

namespace lichtveld::lightfield {

class Links final : public LightField {
 public:
  Links(const gpu::Device& device, const scene::Scene& scene, const Settings& settings);

  TexelView irradiance_view() const override { return {device_, links_.map().total_irradiance}; }
  Shown shown(const Adaptation& adaptation) override;
  gpu::Times times() const override { return device_.times().so_far() - begun_; }

 private:
  bool compute(Light before, const Moves& moves, const Enough& enough, Solution& solution) override;
  double error_estimate() const override;
  LinkCheck check_kept_links(std::uint32_t pairs) override { return links_.check(pairs); }

  void start(Solution& solution);
  void bounce(Solution& solution);
  void note_change(Solution& solution) const;
  void part_bounce(Solution& solution);
  bool converge(Light before, const Enough& enough, Solution& solution);

  const gpu::Device& device_;
  const gpu::Times begun_;  // Device::times() before it all
  const Settings settings_;
  KeptLinks links_;
  Brdf brdf_;
  ToneMap tone_map_;
  Over over_;
  Gather gather_;
  std::uint32_t next_part_ = 0;  // of the directions, to bounce over
};

}  // namespace lichtveld::lightfield
