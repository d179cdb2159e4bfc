// Links of 16 bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "links.glsl"

layout(binding = 0) readonly buffer Table { uint table[]; };

// Of pairs `pair` (even) and `pair` + 1 of the chunk.
uvec2 two_links(uint pair, uint texel, uint pairs) {
  const uint two = table[word_at(pair / 2u, texel, pairs / 2u)];
  return uvec2(two & 0xffffu, two >> 16u);
}

#include "gather.glsl"
