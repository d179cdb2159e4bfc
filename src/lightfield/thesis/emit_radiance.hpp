// emit_radiance: the scene seen along one direction, each surface with its radiance, all layers kept: the
// A-buffer. Thesis, section 4.4; stencil routing: Myers and Bavoil 2007, "Stencil Routed A-Buffer". Subpass 1
// sets the stencil of sample s to s + 1, so that the s-th fragment of a pixel finds a one in sample s alone;
// subpass 2 writes colour and depth through that test and takes one off every sample. A device with fewer
// samples than layers does this in several routed passes. The list kind hands out slots of a per-pixel list by
// an atomic counter instead. Reads the geometry and `radiance`; writes the A-buffer. Costs fragments times
// layers; on lavapipe the samples.
#pragma once

#include <memory>
#include <vector>

#include "lichtveld/lightfield/settings.hpp"
#include "passes/light_map.hpp"
#include "shared.h"

namespace lichtveld::lightfield {

// All surfaces along one direction, per pixel of size * size.
struct LayerStore {
  LayerStore(const gpu::Device& device, const Settings& settings, std::uint32_t capacity);

  std::uint32_t size, capacity;
  std::uint32_t samples;    // layers a routed pass
  vk::raii::Sampler fetch;  // nearest: for texelFetch
  // stencil: rgb radiance, a depth; one array layer a routed pass, one sample a layer
  std::unique_ptr<gpu::Image> routed, stencil;
  // list: capacity slots a pixel, and how many are filled
  std::unique_ptr<gpu::Buffer> layers, filled;

  // For reading, as abuffer_stencil.glsl and abuffer_list.glsl declare it.
  std::vector<gpu::Binding> bindings() const;
};

class EmitRadiance {
 public:
  EmitRadiance(const gpu::Device& device, const LayerStore& store);

  // `limit` layers are asked for; pixels with more are counted into `counters` if `count` is set.
  void record(gpu::Frame& frame, const shaders::PsfView& view, const Geometry& geometry, const LightMap& map,
              const LayerStore& store, std::uint32_t limit, bool count, const gpu::Buffer& counters) const;

 private:
  void record_stencil(gpu::Frame& frame, const shaders::EmitConstants& constants, const Geometry& geometry,
                      const LightMap& map, const LayerStore& store, const gpu::Buffer& counters) const;
  void record_list(gpu::Frame& frame, const shaders::EmitConstants& constants, const Geometry& geometry,
                   const LightMap& map, const LayerStore& store, const gpu::Buffer& counters) const;

  vk::raii::Sampler bilinear_;
  std::vector<gpu::GraphicsPipeline> set_stencil_;  // one a sample
  std::vector<gpu::GraphicsPipeline> draw_;         // one-sided, double-sided
  std::vector<gpu::ComputePipeline> count_;         // stencil only
};

}  // namespace lichtveld::lightfield
