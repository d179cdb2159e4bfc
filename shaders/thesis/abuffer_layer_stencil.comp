// Shows one layer of the A-buffer, in the order of arrival.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(constant_id = 0) const uint LAYERS = 8;
#include "abuffer_stencil.glsl"

layout(local_size_x = SIDE, local_size_y = SIDE) in;
layout(binding = 2, rgba32f) uniform writeonly image2D shown_layer;
layout(push_constant) uniform Push { LayerConstants constants; };

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(constants.size)))) return;
  const bool taken = constants.layer < abuffer_filled(pixel, constants.size);
  const vec4 none = vec4(0.0, 0.0, 0.0, NO_LAYER);
  imageStore(shown_layer, pixel, taken ? abuffer_layer(pixel, constants.size, constants.layer) : none);
}
