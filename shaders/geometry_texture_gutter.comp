// Finds for each texel the one it takes its light from: itself on an open chart texel, else the nearest of those within
// the gutter's width.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(local_size_x = GROUP, local_size_y = GROUP) in;
layout(binding = 0, rgba32f) uniform readonly image2D position;
layout(binding = 1, rgba32f) uniform readonly image2D face_normal;
layout(binding = 2, r32f) uniform readonly image2D cover;  // above 0: most rays start in contact with a surface
layout(binding = 3, r32ui) uniform writeonly uimage2D source;  // y * size + x, or NO_TEXEL
layout(push_constant) uniform Push { GutterConstants constants; };

// A covered texel takes its light from the same face, not from a chart that happens to lie beside it: within 10 degrees,
// so that curved surfaces count as one.
const float SAME_FACE = 0.985;

bool on_chart(ivec2 texel) { return imageLoad(position, texel).a > 0.0; }
bool open(ivec2 texel) { return on_chart(texel) && (constants.covered == 0u || imageLoad(cover, texel).r <= 0.0); }

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  const int size = int(constants.size);
  if (any(greaterThanEqual(texel, ivec2(size)))) return;
  const uint itself = uint(texel.y * size + texel.x);
  const bool chart = on_chart(texel);
  const vec3 face = imageLoad(face_normal, texel).xyz;
  uint found = chart ? itself : NO_TEXEL;
  if (!open(texel)) {
    int best = 1000;
    for (int y = -GUTTER; y <= GUTTER; ++y)
      for (int x = -GUTTER; x <= GUTTER; ++x) {
        const ivec2 near = texel + ivec2(x, y);
        const int distance_squared = x * x + y * y;
        if (distance_squared >= best || any(lessThan(near, ivec2(0))) || any(greaterThanEqual(near, ivec2(size))))
          continue;
        if (open(near) && (!chart || dot(imageLoad(face_normal, near).xyz, face) > SAME_FACE)) {
          best = distance_squared;
          found = uint(near.y * size + near.x);
        }
      }
  }
  imageStore(source, texel, uvec4(found));
}
