// Finds the two nearest walls on each texel's plane, and how far the others are.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(local_size_x = SIDE, local_size_y = SIDE) in;
layout(binding = 0, rgba32f) uniform readonly image2D position;
layout(binding = 1, rgba32f) uniform readonly image2D face_normal;
layout(binding = 2) readonly buffer WallsFirst { uint walls_first[]; };  // of each triangle in walls; one more at the end
layout(binding = 3) uniform samplerBuffer walls;                         // two ends each [m]
layout(binding = 4, rgba32ui) uniform writeonly uimage2D near_walls;     // as LightMap::near_walls

float distance_to(uint wall, vec3 p) {
  const vec3 a = texelFetch(walls, int(2u * wall)).xyz, edge = texelFetch(walls, int(2u * wall + 1u)).xyz - a;
  return distance(p, a + edge * clamp(dot(p - a, edge) / max(dot(edge, edge), 1e-30), 0.0, 1.0));
}

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(position)))) return;
  const vec4 p = imageLoad(position, texel);
  uvec2 walls_found = uvec2(0u);
  vec3 distances = vec3(FAR);  // of the nearest three
  if (p.a > 0.0) {
    const uint triangle = uint(imageLoad(face_normal, texel).a);
    for (uint wall = walls_first[triangle]; wall < walls_first[triangle + 1u]; ++wall) {
      const float away = distance_to(wall, p.xyz);
      if (away < distances.x) {
        distances = vec3(away, distances.xy);
        walls_found = uvec2(wall, walls_found.x);
      } else if (away < distances.y) {
        distances.yz = vec2(away, distances.y);
        walls_found.y = wall;
      } else {
        distances.z = min(distances.z, away);
      }
    }
  }
  if (distances.y == FAR) walls_found.y = walls_found.x;
  imageStore(near_walls, texel, uvec4(walls_found, floatBitsToUint(distances.xz)));
}
