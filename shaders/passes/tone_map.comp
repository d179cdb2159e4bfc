// Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", equations 2 and 4 on luminance; then sRGB.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "luminance.glsl"

layout(local_size_x = SIDE, local_size_y = SIDE) in;
layout(binding = 0, rgba32f) uniform readonly image2D radiance;
layout(binding = 1, r32ui) uniform readonly uimage2D shown;  // the texel whose light to show, or NO_TEXEL
layout(binding = 2, rgba32f) uniform readonly image2D over;  // rgb + (1 - a) of that light
layout(binding = 3) readonly buffer Exposures { Exposure exposure; };
layout(binding = 4, rgba8) uniform writeonly image2D presented;  // sRGB-encoded; black outside charts and gutters

vec3 srgb(vec3 linear) {  // IEC 61966-2-1
  return mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, greaterThan(linear, vec3(0.0031308)));
}

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(radiance)))) return;
  const uint from = imageLoad(shown, texel).r, width = uint(imageSize(radiance).x);
  const vec3 light_there = from == NO_TEXEL ? vec3(0.0) : imageLoad(radiance, ivec2(from % width, from / width)).rgb;
  const vec4 above = imageLoad(over, texel);
  const vec3 colour = max(above.rgb + (1.0 - above.a) * light_there, 0.0);
  const float light = luminance(colour), scale = KEY / exposure.average;
  const float scaled = light * scale, white_scaled = exposure.white * scale;
  const float mapped = scaled * (1.0 + scaled / (white_scaled * white_scaled)) / (1.0 + scaled);
  const vec3 display = light > 0.0 ? colour * (mapped / light) : vec3(0.0);
  imageStore(presented, texel, vec4(srgb(clamp(display, 0.0, 1.0)), 1.0));
}
