// At odds with whole.vert over the push constants.
#version 460

layout(location = 0) out vec4 drawn;
layout(push_constant) uniform Push { vec4 colour; float more; };

void main() { drawn = colour * more; }
