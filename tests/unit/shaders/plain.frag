// Counts what it draws, and reads what whole.vert reads.
#version 460

layout(location = 0) out vec4 drawn;
layout(binding = 0) readonly buffer Depths { float depths[]; };
layout(binding = 1) buffer Count { uint count; };
layout(push_constant) uniform Push { vec4 colour; };

void main() {
  atomicAdd(count, 1u);
  drawn = colour + depths[0];
}
