// Which texels other geometry lies on: most of what they see steeply lies in their own plane and faces them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "links.glsl"
#include "rows.glsl"

layout(local_size_x = GROUP) in;
layout(constant_id = 0) const uint BITS = 16;  // of a link
layout(binding = 0) readonly buffer Table { uint table[]; };
layout(binding = 1) uniform samplerBuffer directions;         // xyz; w: solid angle [sr], of each pair
layout(binding = 2) uniform usamplerBuffer receivers;         // rows.glsl
layout(binding = 3, r32f) uniform writeonly image2D cover;    // as LightMap::cover
layout(binding = 4) readonly buffer Groups { uint groups[]; };  // of texels, to look at
layout(push_constant) uniform Push { CoverConstants constants; };

// Flatter than 60 degrees off the normal a texel meets a block's side as near as its bottom.
const float STEEP = 0.5;
// Faces look at each other within 25 degrees.
const float FACING = 0.9;

uint link_of(uint pair, uint me) {
  if (BITS == 32u) return table[word_at(pair, me, constants.pairs)];
  return table[word_at(pair / 2u, me, constants.pairs / 2u)] >> 16u * (pair & 1u) & 0xffffu;
}

void main() {
  const uint me = groups[gl_WorkGroupID.x] * GROUP + gl_LocalInvocationID.x;
  if (me >= constants.texels) return;
  const Receiver receiver = receiver_at(receivers, me);
  const vec3 face = receiver.face_and_triangle.xyz, at = receiver.at.xyz;
  float balance = 0.0;
  for (uint vote = 0u; vote < constants.votes; ++vote) {
    const uint pair = vote * constants.pairs / constants.votes;
    const float cosine = abs(dot(face, texelFetch(directions, int(pair)).xyz));
    const uint link = link_of(pair, me);
    if (cosine < STEEP || link >= constants.texels) continue;
    const Receiver seen = receiver_at(receivers, link);
    const bool touches = dot(face, seen.face_and_triangle.xyz) < -FACING &&
                         abs(dot(face, seen.at.xyz - at)) <= constants.contact;
    balance += touches ? cosine : -cosine;
  }
  const uint width = uint(imageSize(cover).x), texel = uint(receiver.at.w);
  imageStore(cover, ivec2(texel % width, texel / width), vec4(balance));
}
