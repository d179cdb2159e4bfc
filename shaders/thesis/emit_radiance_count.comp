// Counts the layers of each pixel from what the stencil has left: sample s of routed pass p started at
// p * samples + s + 1 and every fragment took one off, wrapping below zero.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(local_size_x = SIDE, local_size_y = SIDE) in;
layout(constant_id = 0) const uint SAMPLES = 4;
layout(binding = 0) uniform usampler2DMS stencil;  // of routed pass 0
layout(binding = 1) buffer Counted { Counters counters; };
layout(push_constant) uniform Push { EmitConstants constants; };

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(constants.size)))) return;
  uint most = 0u;
  for (int s = 0; s < int(SAMPLES); ++s)
    most = max(most, (uint(s) + 1u - texelFetch(stencil, pixel, s).r) & 0xffu);
  if (most > constants.limit) atomicAdd(counters.overflow_pixels, 1u);
  if (most > counters.layers_max) atomicMax(counters.layers_max, most);
}
