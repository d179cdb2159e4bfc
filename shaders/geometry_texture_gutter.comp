// Finds for each texel the one it takes its light from: itself on a chart, the nearest chart texel in a gutter.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(local_size_x = GROUP, local_size_y = GROUP) in;
layout(binding = 0, rgba32f) uniform readonly image2D position;
layout(binding = 1, r32ui) uniform writeonly uimage2D source;  // y * size + x, or NO_TEXEL
layout(push_constant) uniform Push { TexelConstants constants; };

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  const int size = int(constants.size);
  if (any(greaterThanEqual(texel, ivec2(size)))) return;
  uint found = NO_TEXEL;
  int best = 1000;
  if (imageLoad(position, texel).a > 0.0) {
    found = uint(texel.y * size + texel.x);
  } else {
    for (int y = -GUTTER; y <= GUTTER; ++y)
      for (int x = -GUTTER; x <= GUTTER; ++x) {
        const ivec2 near = texel + ivec2(x, y);
        const int distance_squared = x * x + y * y;
        if (distance_squared >= best || any(lessThan(near, ivec2(0))) || any(greaterThanEqual(near, ivec2(size))))
          continue;
        if (imageLoad(position, near).a > 0.0) {
          best = distance_squared;
          found = uint(near.y * size + near.x);
        }
      }
  }
  imageStore(source, texel, uvec4(found));
}
