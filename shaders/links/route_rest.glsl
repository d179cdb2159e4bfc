// The rays that see nothing at their nearest pixel, or that a wall stands before. Looks at all of the 2 x 2 pixels around
// the texel.
#include "link_rays.glsl"
#include "layers_in_front.glsl"

layout(binding = 6, rgba32f) uniform readonly image2D position;
layout(binding = 7) readonly buffer WallsFirst { uint walls_first[]; };
layout(binding = 8) uniform samplerBuffer walls;
layout(binding = 12) readonly buffer Rest { uvec2 rest[]; };
#include "receiver.glsl"
#include "relink.glsl"

// The 2 x 2 pixels around a texel, the nearest first, without those that any wall stands before; then without those that a
// rising one does.
const uint CHOICES = 8u;

ivec2 pixel_of(uint choice, Sight sight) {
  return clamp(sight.nearest + beside_nearest(choice % 4u, sight.within), ivec2(0), ivec2(constants.size) - 1);
}

// The first choice from `choice` on that no wall hides.
uint next_open(uint choice, Receiver receiver, Sight sight, Region region, Blur blur) {
  const vec3 face = receiver.face_and_triangle.xyz;
  while (choice < CHOICES &&
         wall_between(receiver.near, uint(receiver.face_and_triangle.a), receiver.at.xyz,
                      away_to(shift_to(pixel_of(choice, sight), sight), sight, region), face, blur, choice >= 4u))
    ++choice;
  return choice;
}

void route(uint me, Region region, bool wall_at_nearest) {
  const Receiver receiver = receiver_at(receivers, me);
  const vec3 face = receiver.face_and_triangle.xyz;
  const vec4 at = receiver.at;
  const Sight sight = look(at.xyz, face, region);
  const float pixel_width = 2.0 / float(constants.size);
  const float tolerance = receiver_tolerance(sight.slope, pixel_width);
  const Blur blur = blur_of(pixel_width, sight.scale, sight.travel, sight.face_cosine);
  int link = -1;
  bool known = false;
  // As in stencil_routing: the first that tells what the texel sees. Walls in a loop of their own, so that what follows is
  // done once for nearly all, and not once for each choice that some lane is at.
  for (uint choice = wall_at_nearest ? 1u : 0u; choice < CHOICES; ++choice) {
    choice = next_open(choice, receiver, sight, region, blur);
    if (choice == CHOICES) break;
    const ivec2 pixel = pixel_of(choice, sight);
    const vec2 shift = shift_to(pixel, sight);
    known = true;
    const float limit = receiver_depth(shift, sight.depth, sight.slope) + tolerance;
    link = nearest_in_front(pixel, region, sight.sign, limit, true);
    if (link >= 0) break;
    const uint texel = uint(at.w), width = uint(imageSize(position).x);
    if (chart_reaches(ivec2(texel % width, texel / width), at.xyz, away_to(shift, sight, region))) break;
  }
  relink(me, receiver.normal_and_wall.xyz, region,
         link >= 0 ? uint(link) : known ? MISS(constants.texels) : UNKNOWN(constants.texels));
  if (link >= 0) return;
  if (known) atomicAdd(counters.misses, 1u);
  else atomicAdd(counters.unknown, 1u);
}

void main() {
  const uint count = counters.rest, all = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  for (uint index = gl_GlobalInvocationID.x; index < count; index += all) {
    const uvec2 ray = rest[index];
    const Region region = region_at(regions, ray.y & ~WALL_BETWEEN);
    const uint pair = uint(region.store.z);
    if (pair >= constants.first_pair && pair < constants.first_pair + constants.pairs)
      route(ray.x, region, (ray.y & WALL_BETWEEN) != 0u);
  }
}
