// A part of one bounce's sum over pairs: w L of what each texel sees, lamps' own light apart, and w. Included by a shader
// that defines two_links().

layout(local_size_x = GROUP) in;
layout(binding = 1) uniform samplerBuffer radiance;                 // what each link sees. rgb: L; a: 1; of UNKNOWN all 0
layout(binding = 2) uniform samplerBuffer directions;               // xyz; w: solid angle [sr], of each pair
layout(binding = 3) readonly buffer TexelOf { uint texel_of[]; };
layout(binding = 4, rgba32f) uniform readonly image2D normal;
layout(binding = 5) buffer Sums { vec4 sums[]; };  // of each part and texel. rgb: sum of w L; a: of w [sr]
layout(binding = 6) readonly buffer Groups { uint groups[]; };  // of texels, to look at
layout(push_constant) uniform Push { GatherConstants constants; };

// L of what a link sees.
vec4 seen(uint link) { return texelFetch(radiance, int(min(link, UNKNOWN(constants.texels)))); }

void gather(uint me, vec3 n, uint part) {
  const uint begin = first_pair_of_part(constants.all_pairs, part), first = max(begin, constants.first_pair);
  const uint end = min(first_pair_of_part(constants.all_pairs, part + 1u), constants.first_pair + constants.pairs);
  if (first >= end) return;
  const uint mine = part * constants.texels + me;
  vec4 sum = begin < constants.first_pair ? sums[mine] : vec4(0.0);  // what the chunk before has told
  for (uint pair = first; pair < end; pair += 2u) {
    const vec4 a = texelFetch(directions, int(pair)), b = texelFetch(directions, int(pair + 1u));
    const uvec2 links = two_links(pair - constants.first_pair, me, constants.pairs);
    sum += abs(dot(n, a.xyz)) * a.w * seen(links.x) + abs(dot(n, b.xyz)) * b.w * seen(links.y);
  }
  sums[mine] = sum;
}

void main() {
  const uint group = constants.listed != 0u ? groups[gl_WorkGroupID.x] : gl_WorkGroupID.x;
  const uint me = group * GROUP + gl_LocalInvocationID.x;
  if (me >= constants.texels) return;
  const uint width = uint(imageSize(normal).x);
  const vec3 n = imageLoad(normal, ivec2(texel_of[me] % width, texel_of[me] / width)).xyz;
  for (uint nth = 0u; nth < constants.parts; ++nth) gather(me, n, (constants.first_part + nth) % PARTS);
}
