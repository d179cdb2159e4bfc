// One triangle that covers the whole target, lifted by what a buffer says.
#version 460

layout(binding = 0) readonly buffer Depths { float depths[]; };
layout(push_constant) uniform Push { vec4 colour; };

void main() {
  gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, depths[0] * colour.a, 1.0);
}
