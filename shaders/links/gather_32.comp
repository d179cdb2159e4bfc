// Links of 32 bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "links.glsl"

layout(binding = 0) readonly buffer Table { uint table[]; };

// Of pairs `pair` (even) and `pair` + 1 of the chunk.
uvec2 two_links(uint pair, uint texel, uint pairs) {
  return uvec2(table[word_at(pair, texel, pairs)], table[word_at(pair + 1u, texel, pairs)]);
}

#include "gather.glsl"
