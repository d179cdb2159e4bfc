// At odds with whole.vert over binding 0.
#version 460

layout(location = 0) out vec4 drawn;
layout(binding = 0) readonly buffer Colours { vec4 colours[]; };

void main() { drawn = colours[0]; }
