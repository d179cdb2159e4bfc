// A bounce's end for linked texels: E = pi * (direct + indirect light) / sum of w. Then what the next one gathers:
// L = albedo / pi * E, and Le of what is no lamp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "direct_light.glsl"
#include "finish.glsl"

layout(local_size_x = GROUP) in;
layout(binding = 0) uniform samplerBuffer sums;                 // as gather.glsl's
layout(binding = 1) readonly buffer Direct { uint direct[]; };  // of each texel and half: sum of w Le of lamps [scaled]
layout(binding = 2) readonly buffer TexelOf { uint texel_of[]; };
layout(binding = 3, rgba32f) uniform readonly image2D albedo;
layout(binding = 4, rgba32f) uniform readonly image2D emission;
layout(binding = 5, rgba32f) uniform image2D total_irradiance;           // rgb: E [W m^-2]; a: 1
layout(binding = 6, rgba32f) uniform writeonly image2D half_difference;  // rgb: (E of half 0 - E of half 1) / 2
layout(binding = 7) writeonly buffer Radiance { vec4 radiance[]; };      // as gather.glsl's
layout(binding = 8) writeonly buffer Changed { vec2 changed[]; };        // of a texel: the largest, and the sum of E
layout(binding = 9) readonly buffer Lamps { vec4 lamps[]; };             // rgb: exact E straight from lamps, or 0
layout(push_constant) uniform Push { BounceConstants constants; };

// From half of the directions, lamps left out. rgb: sum of w L; a: of w.
vec4 received(uint me, uint half_of) {
  const uint first = half_of * PARTS / 2u;
  vec4 sum = vec4(0.0);
  for (uint part = first; part < first + PARTS / 2u; ++part) sum += texelFetch(sums, int(part * constants.texels + me));
  return sum;
}

// The same of lamps alone.
vec4 from_lamps(uint me, uint half_of, float weight) {
  vec3 sum;
  for (uint channel = 0u; channel < 3u; ++channel)
    sum[channel] = float(direct[direct_at(me, half_of, channel)]) / constants.direct_scale;
  return vec4(sum, weight);
}

vec3 irradiance_with_lamps(vec4 sum, vec4 lamps) { return irradiance_of(sum, irradiance_of(lamps, vec3(0.0))); }

void main() {
  const uint me = gl_GlobalInvocationID.x;
  if (me >= constants.texels) return;
  const uint width = uint(imageSize(albedo).x);
  const ivec2 texel = ivec2(texel_of[me] % width, texel_of[me] / width);
  const vec3 before = imageLoad(total_irradiance, texel).rgb;
  const vec4 first = received(me, 0u), second = received(me, 1u);
  const vec4 first_lamps = from_lamps(me, 0u, first.a), second_lamps = from_lamps(me, 1u, second.a);
  const vec3 e = lamps[me].rgb + irradiance_with_lamps(first + second, first_lamps + second_lamps), change = abs(e - before);
  imageStore(total_irradiance, texel, vec4(e, 1.0));
  const vec3 apart = irradiance_with_lamps(first, first_lamps) - irradiance_with_lamps(second, second_lamps);
  imageStore(half_difference, texel, vec4(apart / 2.0, 0.0));
  const vec3 own = me < constants.lamps ? vec3(0.0) : imageLoad(emission, texel).rgb;
  radiance[me] = vec4(radiance_of(own, imageLoad(albedo, texel).rgb, e), 1.0);
  if (constants.counted != 0u) changed[me] = vec2(max(change.r, max(change.g, change.b)), e.r + e.g + e.b);
}
