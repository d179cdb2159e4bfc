// Writes the surface at a texel's centre.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;

layout(push_constant) uniform Push { GeometryConstants constants; };

layout(location = 0) out vec4 out_position;     // xyz [m]; a: 1 on valid texels
layout(location = 1) out vec4 out_normal;       // shading normal
layout(location = 2) out vec4 out_face_normal;  // xyz: of the triangle itself, on the same side; a: its number

void main() {
  const uint triangle = constants.first_triangle + uint(gl_PrimitiveID);
  const vec3 face = normalize(cross(dFdx(world_position), dFdy(world_position)));
  const vec3 facing = dot(face, world_normal) < 0.0 ? -face : face;
  const float length_squared = dot(world_normal, world_normal);
  out_position = vec4(world_position, 1.0);
  out_normal = vec4(length_squared > 0.0 ? world_normal * inversesqrt(length_squared) : facing, 0.0);
  out_face_normal = vec4(facing, float(triangle));
}
