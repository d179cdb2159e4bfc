// A binding of every kind, each read or written in one way.
#version 460

layout(local_size_x = 4) in;
layout(binding = 0) writeonly buffer Sums { uint sums[]; };
layout(binding = 2) readonly buffer Numbers { uint numbers[]; };
layout(binding = 3, r32ui) uniform readonly uimage2D given;
layout(binding = 4, r32ui) uniform uimage2D kept;
layout(binding = 5) uniform usamplerBuffer fetched;
layout(binding = 7) uniform usampler2D seen;
layout(push_constant) uniform Push { uint added, unused; };

void main() {
  const int at = int(gl_GlobalInvocationID.x);
  const uint before = imageLoad(kept, ivec2(at, 0)).r;
  imageStore(kept, ivec2(at, 0), uvec4(before + 1u));
  sums[at] = numbers[at] + imageLoad(given, ivec2(at, 0)).r + before + texelFetch(fetched, at).r +
             texelFetch(seen, ivec2(at, 0), 0).r + added;
}
