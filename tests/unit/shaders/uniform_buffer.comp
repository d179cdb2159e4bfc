// Of a kind that no pipeline binds.
#version 460

layout(local_size_x = 1) in;
layout(binding = 0) uniform Settings { uint setting; };
layout(binding = 1) writeonly buffer Sums { uint sums[]; };

void main() { sums[0] = setting; }
