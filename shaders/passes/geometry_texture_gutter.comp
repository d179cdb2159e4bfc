// Finds for each texel the one whose light players see there: itself on an open chart texel, else the nearest of those
// within the gutter's width.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(local_size_x = SIDE, local_size_y = SIDE) in;
layout(binding = 0, rgba32f) uniform readonly image2D position;
layout(binding = 1, rgba32f) uniform readonly image2D face_normal;
layout(binding = 2, r32f) uniform readonly image2D cover;  // above 0: most rays start in contact with a surface
layout(binding = 3, r32ui) uniform readonly uimage2D source;  // as LightMap::source
layout(binding = 4, r32ui) uniform writeonly uimage2D shown;   // y * size + x, or NO_TEXEL

// A covered texel takes its light from the same face, not from a chart that happens to lie beside it: within 10 degrees,
// so that curved surfaces count as one.
const float SAME_FACE = 0.985;

const int SQUARE = 2 * GUTTER + 1;  // of the square that is looked at [texels]

bool on_chart(ivec2 texel) { return imageLoad(position, texel).a > 0.0; }
bool open(ivec2 texel) { return on_chart(texel) && imageLoad(cover, texel).r <= 0.0; }

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  const uint size = uint(imageSize(position).x);
  if (any(greaterThanEqual(texel, ivec2(size)))) return;
  const bool chart = on_chart(texel);
  uint nearest = chart ? uint(texel.y) * size + uint(texel.x) : NO_TEXEL;
  bool done = open(texel);
  if (!chart) {  // most gutters need no search: the nearest of all is open
    const uint of_all = imageLoad(source, texel).r;
    done = of_all == NO_TEXEL || open(ivec2(of_all % size, of_all / size));
    if (done) nearest = of_all;
  }
  // A loop that starts where it ends for who is done: a device that runs all lanes through both sides of a branch leaves it
  // out where all are.
  const vec3 face = imageLoad(face_normal, texel).xyz;
  int best = 1000;
  for (int beside = done ? SQUARE * SQUARE : 0; beside < SQUARE * SQUARE; ++beside) {
    const ivec2 step = ivec2(beside % SQUARE, beside / SQUARE) - GUTTER, near = texel + step;
    const int distance_squared = step.x * step.x + step.y * step.y;
    if (distance_squared >= best || any(lessThan(near, ivec2(0))) || any(greaterThanEqual(near, ivec2(size)))) continue;
    if (open(near) && (!chart || dot(imageLoad(face_normal, near).xyz, face) > SAME_FACE)) {
      best = distance_squared;
      nearest = uint(near.y) * size + uint(near.x);
    }
  }
  imageStore(shown, texel, uvec4(nearest));
}
