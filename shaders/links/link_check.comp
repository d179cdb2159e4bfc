// Links of two pairs that were routed again, against those that are kept: how many differ.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "links.glsl"

layout(local_size_x = GROUP) in;
layout(constant_id = 0) const uint BITS = 16;  // of a link
layout(binding = 0) readonly buffer Table { uint table[]; };
layout(binding = 1) readonly buffer Again { uint again[]; };
layout(binding = 2) buffer Counted { Counters counters; };
layout(binding = 3) readonly buffer TexelOf { uint texel_of[]; };
layout(push_constant) uniform Push { CheckConstants constants; };

// Where a pixel's centre sees the border of two texels, rounding decides: to see the one beside is no difference.
bool differ(uint a, uint b) {
  if (a == b) return false;
  if (max(a, b) >= constants.texels) return true;
  const uvec2 at = uvec2(texel_of[a] % constants.size, texel_of[a] / constants.size);
  const uvec2 again = uvec2(texel_of[b] % constants.size, texel_of[b] / constants.size);
  return any(greaterThan(abs(ivec2(at) - ivec2(again)), ivec2(1)));
}

uint differing(uint a, uint b) {
  if (BITS == 32u) return uint(differ(a, b));
  return uint(differ(a & 0xffffu, b & 0xffffu)) + uint(differ(a >> 16u, b >> 16u));
}

void main() {
  const uint words = 2u * BITS / 32u;
  uint count = 0u;
  for (uint me = gl_GlobalInvocationID.x; me < constants.texels; me += gl_NumWorkGroups.x * GROUP)
    for (uint word = 0u; word < words; ++word)
      count += differing(table[word_at(constants.first_word + word, me, constants.words)], again[word_at(word, me, words)]);
  if (count > 0u) atomicAdd(counters.differing, count);
}
