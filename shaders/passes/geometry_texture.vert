// Draws each triangle at its place in the atlas.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 atlas;

layout(push_constant) uniform Push { GeometryConstants constants; };

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;

void main() {
  world_position = position + constants.offset.xyz;
  world_normal = normal;
  gl_Position = vec4(atlas * 2.0 - 1.0, 0.0, 1.0);  // v = 0 is the top row
}
