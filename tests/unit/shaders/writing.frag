// Writes what whole.vert reads.
#version 460

layout(binding = 0) buffer Depths { float depths[]; };

void main() { depths[1] = gl_FragCoord.z; }
