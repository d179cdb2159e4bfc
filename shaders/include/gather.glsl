// A part of one bounce's sum over pairs: w L of what each texel sees, lamps' own light apart, and w. Included by a shader
// that defines two_links().

layout(local_size_x = TILE) in;
layout(binding = 1) uniform samplerBuffer radiance;                 // what each link sees. rgb: L; a: 1; of UNKNOWN all 0
layout(binding = 2) uniform samplerBuffer directions;               // xyz; w: solid angle [sr], of each pair
layout(binding = 3) readonly buffer TexelOf { uint texel_of[]; };
layout(binding = 4, rgba32f) uniform readonly image2D normal;
layout(binding = 5) buffer Sums { vec4 sums[]; };  // of each part and texel. rgb: sum of w L; a: of w [sr]
layout(push_constant) uniform Push { GatherConstants constants; };

// L of what a link sees.
vec4 seen(uint link) { return texelFetch(radiance, int(min(link, UNKNOWN(constants.texels)))); }

void main() {
  const uint me = gl_GlobalInvocationID.x;
  if (me >= constants.texels) return;
  const uint width = uint(imageSize(normal).x);
  const vec3 n = imageLoad(normal, ivec2(texel_of[me] % width, texel_of[me] / width)).xyz;
  const uint mine = constants.part * constants.texels + me;
  vec4 sum = constants.add != 0u ? sums[mine] : vec4(0.0);
  for (uint pair = constants.first; pair < constants.end; pair += 2u) {
    const int first = int(constants.first_pair + pair);
    const vec4 a = texelFetch(directions, first), b = texelFetch(directions, first + 1);
    const uvec2 links = two_links(pair, me, constants.pairs);
    sum += abs(dot(n, a.xyz)) * a.w * seen(links.x) + abs(dot(n, b.xyz)) * b.w * seen(links.y);
  }
  sums[mine] = sum;
}
