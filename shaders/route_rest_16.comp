// The rest of the links, of 16 bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "shared.h"
#include "links.glsl"

// Two pairs share a word, so that a bounce loads both at once.
layout(binding = 9) buffer Table { uint16_t table[]; };
void put_link(uint pair, uint texel, uint link);

#include "route_rest.glsl"

void put_link(uint pair, uint texel, uint link) {
  table[2u * ((pair / 2u) * constants.texels + texel) + pair % 2u] = uint16_t(link);
}
