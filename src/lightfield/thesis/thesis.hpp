// The engine `thesis`: virtual light fields as published. Every PSF is rendered afresh in every bounce.
#pragma once

#include <memory>
#include <optional>

#include "core/lamp_light.hpp"
#include "lichtveld/lightfield/directions.hpp"
#include "lichtveld/lightfield/light_field.hpp"
#include "lichtveld/lightfield/settings.hpp"
#include "passes/brdf.hpp"
#include "passes/geometry_texture.hpp"
#include "passes/over.hpp"
#include "passes/tone_map.hpp"
#include "thesis/blend.hpp"
#include "thesis/emit_radiance.hpp"
#include "thesis/stencil_routing.hpp"

namespace lichtveld::lightfield {

class Thesis final : public LightField {
 public:
  Thesis(const gpu::Device& device, const scene::Scene& scene, const Settings& settings);

  TexelView irradiance_view() const override { return {device_, map_.total_irradiance}; }
  Shown shown(const Adaptation& adaptation) override;
  void observe(StageObserver observer, std::uint32_t direction) override;
  gpu::Times times() const override { return device_.times().so_far() - begun_; }

 private:
  // Everything that depends on how many layers the A-buffer holds.
  struct Layered {
    Layered(const gpu::Device& device, const Settings& settings, std::uint32_t capacity);
    LayerStore store;
    EmitRadiance emit;
    StencilRouting route;
    ShowLayer show;
  };

  bool compute(Light before, const Moves& moves, const Enough& enough, Solution& solution) override;
  double error_estimate() const override;

  std::uint32_t capacity_for(std::uint32_t layers) const;
  bool done(const Solution& solution) const;
  void begin(const Moves& moves);
  void render_bounce(Solution& solution, bool count);
  void render_psfs(Range range, bool count, Solution& solution);
  bool widen(const Solution& solution);
  void clear_bounce(gpu::Frame& frame) const;
  void light_by_lamps(const Moves& moves);
  void end_bounce(const Solution& solution);
  void show_stages();
  void show_result();

  const gpu::Device& device_;
  const gpu::Times begun_;  // Device::times() before it all
  const Settings settings_;
  const DirectionSet directions_;
  const TexelRecords records_;
  Geometry geometry_;
  LightMap map_;
  BounceSums sums_;
  std::unique_ptr<Layered> layered_;  // from the first light on
  GeometryTexture geometry_texture_;
  Blend blend_;
  Brdf brdf_;
  ToneMap tone_map_;
  Over over_;
  gpu::Buffer counters_;
  std::unique_ptr<const scene::RayIndex> index_;  // of lamps_
  std::optional<LampLight> lamps_;                // with Direct::exact
  StageObserver observer_;
  std::uint32_t observed_ = 0;  // direction
};

}  // namespace lichtveld::lightfield
