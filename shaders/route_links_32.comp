// Links of 32 bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "links.glsl"

layout(binding = 9) buffer Table { uint table[]; };
void put_link(uint pair, uint texel, uint link);

#include "route_links.glsl"

void put_link(uint pair, uint texel, uint link) {
  table[pair * constants.texels + texel] = link;
}
