// Which texel each texel sees along a pair's two directions. Like stencil_routing, but what is found is kept. Takes what
// the nearest pixel tells, which is nearly always right: rays that see nothing, or with a wall so near that it may stand
// between, are doubts for route_doubts to look at. No branches: a device that runs all lanes through both sides of each
// would pay for the rare one every time.
#include "link_rays.glsl"
#include "layers_in_front.glsl"
#include "receiver_plane.glsl"
#include "relink.glsl"

layout(binding = 3) readonly buffer Jobs { RouteJob jobs[]; };  // of each workgroup
layout(binding = 5) writeonly buffer Doubts { uvec2 doubts[]; };
layout(binding = 11) readonly buffer Tiles { uint tiles[]; };

void route(uint me, uint index, Region region) {
  const bool valid = me < constants.texels;
  me = min(me, constants.texels - 1u);
  const Receiver receiver = receiver_at(receivers, me);
  const vec3 face = receiver.face_and_triangle.xyz;
  const Sight sight = look(receiver.at.xyz, face, region);
  const float pixel_width = 2.0 / float(constants.size);
  const bool wanted = valid && sight.inside;
  const bool lit = sight.face_cosine > 0.0 && dot(receiver.normal_and_wall.xyz, sight.travel) < 0.0;
  const vec2 shift = shift_to(sight.nearest, sight);
  const float limit =
      receiver_depth(shift, sight.depth, sight.slope) + receiver_tolerance(sight.slope, pixel_width);
  const int link = nearest_in_front(sight.nearest, region, sight.sign, limit, wanted && lit);
  const float reach =
      length(away_to(shift, sight, region)) +
      most_blur(blur_of(pixel_width, sight.scale, sight.travel, sight.face_cosine));
  if (!wanted) return;
  if (!lit || link >= 0)
    relink(me, receiver.normal_and_wall.xyz, region, lit ? uint(link) : UNKNOWN(constants.texels));
  if (lit && (link < 0 || reach >= receiver.normal_and_wall.w))
    doubts[atomicAdd(counters.doubts, 1u)] = uvec2(me, link < 0 ? index | NOTHING_SEEN : index);
}

void main() {
  const RouteJob job = jobs[constants.first_job + gl_WorkGroupID.x];
  const Region region = region_at(regions, job.region);
  for (uint entry = job.first; entry < job.end; ++entry)
    route(tiles[entry] * gl_WorkGroupSize.x + gl_LocalInvocationID.x, job.region, region);
}
