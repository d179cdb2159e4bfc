// Direct light of each texel, from the links of a chunk: for each half of the directions the sum of w Le of the lamps that it
// sees. What relink.glsl keeps up, afresh.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "links.glsl"
#include "direct_light.glsl"

layout(local_size_x = GROUP) in;
layout(constant_id = 0) const uint BITS = 16;  // of a link
layout(binding = 0) readonly buffer Table { uint table[]; };
layout(binding = 1) uniform samplerBuffer directions;  // xyz; w: solid angle [sr], of each pair
layout(binding = 2) readonly buffer TexelOf { uint texel_of[]; };
layout(binding = 3, rgba32f) uniform readonly image2D normal;
layout(binding = 4) readonly buffer Lamps { float lamps[]; };  // Le of each, three channels [scaled]
layout(binding = 5) buffer Direct { uint direct[]; };          // direct_light.glsl
layout(push_constant) uniform Push { DirectConstants constants; };

void main() {
  const uint me = gl_GlobalInvocationID.x;
  if (me >= constants.texels) return;
  const uint width = uint(imageSize(normal).x);
  const vec3 n = imageLoad(normal, ivec2(texel_of[me] % width, texel_of[me] / width)).xyz;
  const uint each = 32u / BITS, words = constants.pairs / each;  // links a word
  for (uint word = 0u; word < words; ++word) {
    const uint links = table[word_at(word, me, words)];
    const uint least = each == 1u ? links : min(links & 0xffffu, links >> 16u);
    // A loop, which a device that runs all lanes through both sides of a branch leaves out where none sees a lamp.
    const uint shares = least < constants.lamps ? 3u * each : 0u;
    for (uint share = 0u; share < shares; ++share) {
      const uint nth = share / 3u, channel = share % 3u, pair = constants.first_pair + word * each + nth;
      const uint link = each == 1u ? links : links >> 16u * nth & 0xffffu;
      if (link < constants.lamps)
        direct[direct_at(me, pair < constants.half_pairs ? 0u : 1u, channel)] +=
            direct_share(lamps[3u * link + channel], n, texelFetch(directions, int(pair)));
    }
  }
}
