// Irradiance to radiance: L = Le + albedo / pi * E, in gutters too.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "finish.glsl"

layout(local_size_x = SIDE, local_size_y = SIDE) in;
layout(binding = 0, r32ui) uniform readonly uimage2D source;
layout(binding = 1, rgba32f) uniform readonly image2D albedo;
layout(binding = 2, rgba32f) uniform readonly image2D emission;
layout(binding = 3, rgba32f) uniform readonly image2D total_irradiance;
layout(binding = 4, rgba32f) uniform writeonly image2D radiance;  // rgb: L [W m^-2 sr^-1]; a: 1 on charts and gutters
layout(push_constant) uniform Push { BrdfConstants constants; };

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  const ivec2 size = imageSize(radiance);
  if (any(greaterThanEqual(texel, size))) return;
  const uint from = imageLoad(source, texel).r;
  vec4 result = vec4(0.0);
  if (from != NO_TEXEL) {
    const ivec2 at = ivec2(from % uint(size.x), from / uint(size.x));
    result = vec4(radiance_of(constants.emitted * imageLoad(emission, at).rgb, imageLoad(albedo, at).rgb, imageLoad(total_irradiance, at).rgb), 1.0);
  }
  imageStore(radiance, texel, result);
}
