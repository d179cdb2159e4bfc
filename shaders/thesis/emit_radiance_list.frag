// One layer of the per-pixel list: an atomic counter hands out the slots.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "emitted.glsl"

layout(location = 0) in vec2 atlas_coordinate;
layout(location = 1) in float psf_depth;
layout(push_constant) uniform Push { EmitConstants constants; };
layout(binding = 1) uniform sampler2D radiance;
layout(binding = 2) buffer Filled { uint filled[]; };  // layers of each pixel so far
layout(binding = 3) writeonly buffer Layers { vec4 layers[]; };
layout(binding = 4) buffer Counted { Counters counters; };

void main() {
  const vec4 layer = emitted(radiance, atlas_coordinate, psf_depth, gl_FrontFacing);
  const uint pixel = uint(gl_FragCoord.y) * constants.size + uint(gl_FragCoord.x);
  const uint slot = atomicAdd(filled[pixel], 1u);
  if (slot < constants.capacity) layers[pixel * constants.capacity + slot] = layer;
  if (constants.count == 0u) return;
  if (slot == constants.limit) atomicAdd(counters.overflow_pixels, 1u);
  if (slot >= counters.layers_max) atomicMax(counters.layers_max, slot + 1u);  // a stale read only costs an atomic
}
