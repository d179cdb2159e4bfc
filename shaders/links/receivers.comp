// What routing and gathering ask of each valid texel, in the order of their numbers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(local_size_x = GROUP) in;
layout(binding = 0) readonly buffer TexelOf { uint texel_of[]; };  // atlas texel of each valid one
layout(binding = 1, rgba32f) uniform readonly image2D position;
layout(binding = 2, rgba32f) uniform readonly image2D normal;
layout(binding = 3, rgba32f) uniform readonly image2D face_normal;
layout(binding = 4, rgba32ui) uniform readonly uimage2D near_walls;
layout(binding = 5) writeonly buffer Receivers { Receiver receivers[]; };
layout(push_constant) uniform Push { ReceiveConstants constants; };

void main() {
  const uint me = gl_GlobalInvocationID.x;
  if (me >= constants.texels) return;
  const uint width = uint(imageSize(position).x), number = texel_of[me];
  const ivec2 texel = ivec2(number % width, number / width);
  const uvec4 near = imageLoad(near_walls, texel);
  receivers[me] = Receiver(vec4(imageLoad(position, texel).xyz, float(number)), imageLoad(face_normal, texel),
                           vec4(imageLoad(normal, texel).xyz, uintBitsToFloat(near.z)), near);
}
