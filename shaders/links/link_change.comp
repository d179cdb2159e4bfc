// What a bounce has changed at most, and the sum of E, of all texels that a workgroup goes through.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(local_size_x = GROUP) in;
layout(binding = 0) readonly buffer Changed { vec2 changed[]; };    // link_bounce.comp's
layout(binding = 1) writeonly buffer Changes { vec2 changes[]; };   // of each workgroup
layout(push_constant) uniform Push { ChangeConstants constants; };

shared vec2 partial[GROUP];

vec2 both(vec2 a, vec2 b) { return vec2(max(a.x, b.x), a.y + b.y); }

void main() {
  const uint lane = gl_LocalInvocationID.x;
  vec2 mine = vec2(0.0);
  for (uint me = gl_GlobalInvocationID.x; me < constants.texels; me += gl_NumWorkGroups.x * GROUP)
    mine = both(mine, changed[me]);
  partial[lane] = mine;
  for (uint width = GROUP / 2u; width > 0u; width /= 2u) {
    barrier();
    if (lane < width) partial[lane] = both(partial[lane], partial[lane + width]);
  }
  if (lane == 0u) changes[gl_WorkGroupID.x] = partial[0];
}
