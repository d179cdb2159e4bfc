// Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", equations 2 and 4 on luminance; then sRGB.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "luminance.glsl"

layout(local_size_x = SIDE, local_size_y = SIDE) in;
layout(binding = 0, rgba32f) uniform readonly image2D radiance;
layout(binding = 1, r32ui) uniform readonly uimage2D shown;  // the texel whose light to show, or NO_TEXEL
layout(binding = 2, r32ui) uniform readonly uimage2D over;  // the number of a value in overs, from 1 on, or 0
layout(binding = 3) readonly buffer Overs { vec4 overs[]; };  // rgb + (1 - a) of the light is shown
layout(binding = 4) readonly buffer Exposures { Exposure exposure; };
layout(binding = 5, rgba8) uniform writeonly image2D presented;  // sRGB-encoded; black outside charts and gutters

vec3 srgb(vec3 linear) {  // IEC 61966-2-1
  return mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, greaterThan(linear, vec3(0.0031308)));
}

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(radiance)))) return;
  const uint from = imageLoad(shown, texel).r, width = uint(imageSize(radiance).x);
  const vec3 light_there = from == NO_TEXEL ? vec3(0.0) : imageLoad(radiance, ivec2(from % width, from / width)).rgb;
  const uint number = imageLoad(over, texel).r;
  const vec4 above = number == 0 ? vec4(0.0) : overs[number - 1];
  const vec3 colour = max(above.rgb + (1.0 - above.a) * light_there, 0.0);
  const float light = luminance(colour), scale = KEY / exposure.average;
  const float scaled = light * scale, white_scaled = exposure.white * scale;
  const float mapped = scaled * (1.0 + scaled / (white_scaled * white_scaled)) / (1.0 + scaled);
  const vec3 display = light > 0.0 ? colour * (mapped / light) : vec3(0.0);
  imageStore(presented, texel, vec4(srgb(clamp(display, 0.0, 1.0)), 1.0));
}
