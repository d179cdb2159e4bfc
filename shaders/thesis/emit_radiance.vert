// Sees the scene along one direction, orthographically.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(location = 0) in vec3 position;
layout(location = 2) in vec2 atlas;
layout(location = 4) in uint body;

layout(push_constant) uniform Push { EmitConstants constants; };
layout(binding = 0) readonly buffer Offsets { vec4 offsets[]; };  // of each body [m]

layout(location = 0) out vec2 atlas_coordinate;
layout(location = 1) out float psf_depth;

void main() {
  const vec4 p = vec4(position + offsets[body].xyz, 1.0);
  const PsfView view = constants.view;
  atlas_coordinate = atlas;
  psf_depth = dot(view.along, p);
  gl_Position = vec4(dot(view.right, p), dot(view.up, p), 0.5, 1.0);
}
