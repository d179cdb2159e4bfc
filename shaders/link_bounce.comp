// A bounce's end for linked texels: E = pi * sum w L / sum w, then L = Le + albedo / pi * E, kept for the next.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "packed_radiance.glsl"

layout(local_size_x = TILE) in;
layout(binding = 0) readonly buffer Sums0 { vec4 sums_0[]; };  // of each half of the directions
layout(binding = 1) readonly buffer Sums1 { vec4 sums_1[]; };
layout(binding = 2) readonly buffer TexelOf { uint texel_of[]; };
layout(binding = 3, rgba32f) uniform readonly image2D albedo;
layout(binding = 4, rgba32f) uniform readonly image2D emission;
layout(binding = 5, rgba32f) uniform image2D total_irradiance;           // rgb: E [W m^-2]; a: 1
layout(binding = 6, rgba32f) uniform writeonly image2D half_difference;  // rgb: (E of half 0 - E of half 1) / 2
layout(binding = 7) writeonly buffer Packed { uint packed_radiance[]; };
layout(binding = 8) writeonly buffer Changes { vec2 changes[]; };        // largest change and sum of E, a workgroup
layout(binding = 9) writeonly buffer Full { float full_radiance[]; };   // three each
layout(push_constant) uniform Push { BounceConstants constants; };

const float PI = 3.14159265358979;
shared vec2 partial[TILE];

vec3 irradiance(vec4 sum) { return sum.a > 0.0 ? PI * sum.rgb / (sum.a * constants.radiance_scale) : vec3(0.0); }

void main() {
  const uint me = gl_GlobalInvocationID.x, lane = gl_LocalInvocationID.x;
  vec2 mine = vec2(0.0);
  if (me < constants.texels) {
    const uint width = uint(imageSize(albedo).x);
    const ivec2 texel = ivec2(texel_of[me] % width, texel_of[me] / width);
    const vec3 before = imageLoad(total_irradiance, texel).rgb;
    const vec4 first = sums_0[me], second = sums_1[me];
    const vec3 e = irradiance(first + second), change = abs(e - before);
    imageStore(total_irradiance, texel, vec4(e, 1.0));
    imageStore(half_difference, texel, vec4((irradiance(first) - irradiance(second)) / 2.0, 0.0));
    const vec3 l = imageLoad(emission, texel).rgb + imageLoad(albedo, texel).rgb / PI * e;
    const vec3 scaled = l * constants.radiance_scale;
    packed_radiance[me] = pack_radiance(scaled);
    for (uint k = 0u; k < 3u; ++k) full_radiance[3u * me + k] = scaled[k];
    mine = vec2(max(change.r, max(change.g, change.b)), e.r + e.g + e.b);
  }
  partial[lane] = mine;
  for (uint width = TILE / 2u; width > 0u; width /= 2u) {
    barrier();
    if (lane < width) {
      const vec2 other = partial[lane + width];
      partial[lane] = vec2(max(partial[lane].x, other.x), partial[lane].y + other.y);
    }
  }
  if (lane == 0u) changes[gl_WorkGroupID.x] = partial[0];
}
