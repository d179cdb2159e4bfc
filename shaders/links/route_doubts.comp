// Whether a wall stands between a texel and the pixel that told what it sees. Then its ray, like those that saw nothing,
// belongs to the rest.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "link_rays.glsl"

layout(binding = 5) readonly buffer Doubts { uvec2 doubts[]; };
layout(binding = 8) uniform samplerBuffer walls;
layout(binding = 12) writeonly buffer Rest { uvec2 rest[]; };
#include "receiver_plane.glsl"
#include "wall.glsl"

void main() {
  const uint count = counters.doubts, all = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  for (uint index = gl_GlobalInvocationID.x; index < count; index += all) {
    const uvec2 doubt = doubts[index], ray = uvec2(doubt.x, doubt.y & ~NOTHING_SEEN);
    const Region region = region_at(regions, ray.y);
    const Receiver receiver = receiver_at(receivers, ray.x);
    const vec3 at = receiver.at.xyz, face = receiver.face_and_triangle.xyz;
    const Sight sight = look(at, face, region);
    const Blur blur = blur_of(2.0 / float(constants.size), sight.scale, sight.travel, sight.face_cosine);
    const vec3 away = away_to(shift_to(sight.nearest, sight), sight, region);
    const float reach = length(away) + most_blur(blur);
    // As in wall_between: without a wall in reach, those that are named may be anywhere.
    const bool between = reach >= uintBitsToFloat(receiver.near.z) &&
                         (is_between(receiver.near.x, at, away, face, blur, false) ||
                          is_between(receiver.near.y, at, away, face, blur, false));
    // With three walls in reach the two nearest do not decide.
    if (doubt != ray || between || reach >= uintBitsToFloat(receiver.near.w))
      rest[atomicAdd(counters.rest, 1u)] = uvec2(ray.x, between ? ray.y | WALL_BETWEEN : ray.y);
  }
}
