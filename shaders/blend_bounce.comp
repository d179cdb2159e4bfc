// Bounce into total: E = pi * sum w_k L_k / sum w_k. The emitted radiance already held all earlier bounces, so that the
// new total takes the old one's place.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(local_size_x = GROUP, local_size_y = GROUP) in;
layout(binding = 0, rgba32f) uniform image2D bounce_irradiance;
layout(binding = 1, rgba32f) uniform readonly image2D position;
layout(binding = 2, rgba32f) uniform writeonly image2D total_irradiance;  // rgb: E [W m^-2]; a: 1 on valid texels

const float PI = 3.14159265358979;

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(total_irradiance)))) return;
  const vec4 sum = imageLoad(bounce_irradiance, texel);
  const vec3 irradiance = sum.a > 0.0 ? PI * sum.rgb / sum.a : vec3(0.0);
  imageStore(total_irradiance, texel, vec4(irradiance, imageLoad(position, texel).a));
  imageStore(bounce_irradiance, texel, vec4(0.0));
}
