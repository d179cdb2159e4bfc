// Bounce into total: E = pi * sum w_k L_k / sum w_k. The emitted radiance already held all earlier bounces, so that the
// new total takes the old one's place.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "finish.glsl"

layout(local_size_x = SIDE, local_size_y = SIDE) in;
layout(binding = 0, rgba32f) uniform image2D bounce_irradiance_0;  // of each half of the directions
layout(binding = 1, rgba32f) uniform image2D bounce_irradiance_1;
layout(binding = 2, rgba32f) uniform readonly image2D position;
layout(binding = 3, rgba32f) uniform writeonly image2D total_irradiance;  // rgb: E [W m^-2]; a: 1 on valid texels
layout(binding = 4, rgba32f) uniform writeonly image2D half_difference;   // rgb: (E of half 0 - E of half 1) / 2
layout(binding = 5, rgba32f) uniform readonly image2D lamp_irradiance;    // rgb: E straight from lamps, or 0

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(total_irradiance)))) return;
  const vec4 first = imageLoad(bounce_irradiance_0, texel), second = imageLoad(bounce_irradiance_1, texel);
  imageStore(total_irradiance, texel, vec4(irradiance_of(first + second, imageLoad(lamp_irradiance, texel).rgb), imageLoad(position, texel).a));
  imageStore(half_difference, texel, vec4((irradiance_of(first, vec3(0.0)) - irradiance_of(second, vec3(0.0))) / 2.0, 0.0));
  imageStore(bounce_irradiance_0, texel, vec4(0.0));
  imageStore(bounce_irradiance_1, texel, vec4(0.0));
}
