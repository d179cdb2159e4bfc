// One layer of a pixel's list: which texel is there, and which way it sends its light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "layer_link.glsl"
#include "emitted.glsl"

layout(constant_id = 0) const uint DOUBLE_SIDED = 0;
layout(location = 0) in vec2 atlas_coordinate;
layout(location = 1) in float psf_depth;
layout(location = 2) flat in uvec2 stored;
layout(push_constant) uniform Push { EmitLinksConstants constants; };
layout(binding = 2, r32ui) uniform readonly uimage2D number;  // of each atlas texel's source among the valid ones
layout(binding = 3) buffer Filled { uint filled[]; };         // layers of each pixel so far: layer_link.glsl
layout(binding = 4) writeonly buffer Layers { uvec2 layers[]; };

void add(uint pixel, uint texel, bool along, float depth) {
  const uint nth = layers_of(atomicAdd(filled[pixel], along ? SENDS_ALONG : SENDS_BACK), along);
  if (nth < constants.capacity)
    layers[slot_of(nth, along, constants.capacity) * constants.store_pixels + pixel] = layer_link(texel, depth);
}

void main() {
  const ivec2 size = imageSize(number);
  const uint texel = imageLoad(number, clamp(ivec2(atlas_coordinate * vec2(size)), ivec2(0), size - 1)).r;
  const uint pixel = stored.x + uint(gl_FragCoord.y) * stored.y + uint(gl_FragCoord.x);
  const float behind = back_shift(psf_depth);
  const bool along = gl_FrontFacing;  // its front sends along the direction
  add(pixel, texel, along, psf_depth);
  // Seen from behind it also sends the other way, from just behind its own texels.
  if (DOUBLE_SIDED != 0u) add(pixel, texel, !along, psf_depth + (along ? -behind : behind));
}
