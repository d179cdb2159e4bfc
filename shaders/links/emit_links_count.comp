// How many layers the store's pixels have: the most of one, and how many have more than were asked for.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "layer_link.glsl"

layout(local_size_x = GROUP) in;
layout(binding = 0) readonly buffer Filled { uint filled[]; };
layout(binding = 1) buffer Counted { Counters counters; };
layout(push_constant) uniform Push { CountLayersConstants constants; };

void main() {
  uint most = 0u, over = 0u;
  for (uint pixel = gl_GlobalInvocationID.x; pixel < constants.pixels; pixel += gl_NumWorkGroups.x * GROUP) {
    const uint layers = layers_of_both(filled[pixel]);
    most = max(most, layers);
    if (layers > constants.limit) ++over;
  }
  if (most > counters.layers_max) atomicMax(counters.layers_max, most);  // a stale read only costs an atomic
  if (over > 0u) atomicAdd(counters.overflow_pixels, over);
}
