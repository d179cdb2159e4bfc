// PSF into bounce: sums w_k L_k and w_k.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(local_size_x = SIDE, local_size_y = SIDE) in;
layout(binding = 0, rgba32f) uniform readonly image2D psf_irradiance;
layout(binding = 1, rgba32f) uniform image2D bounce_irradiance;  // of its half; rgb: sum of w_k L_k; a: sum of w_k

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(bounce_irradiance)))) return;
  imageStore(bounce_irradiance, texel, imageLoad(bounce_irradiance, texel) + imageLoad(psf_irradiance, texel));
}
