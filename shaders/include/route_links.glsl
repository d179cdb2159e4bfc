// Which texel each texel sees along a pair's two directions. Like stencil_routing, but what is found is kept.
// Included by a shader that declares `table` at binding 9 and put_link(index of the pair in the chunk, texel, link).

layout(local_size_x_id = 1) in;  // a tile
layout(binding = 0) readonly buffer Layers { uvec2 layers[]; };
layout(binding = 1) readonly buffer Filled { uint filled[]; };
layout(binding = 2) readonly buffer Regions { Region regions[]; };
layout(binding = 3) readonly buffer Jobs { RouteJob jobs[]; };  // of each workgroup
layout(binding = 11) readonly buffer Tiles { uint tiles[]; };
layout(binding = 4) readonly buffer Receivers { Receiver receivers[]; };
layout(binding = 5) readonly buffer Positions { vec4 positions[]; };  // xyz [m]; w: the atlas texel
layout(binding = 6, rgba32f) uniform readonly image2D position;
layout(binding = 7) readonly buffer WallsFirst { uint walls_first[]; };
layout(binding = 8) readonly buffer Walls { vec4 walls[]; };
layout(binding = 10) buffer Counted { Counters counters; };
layout(push_constant) uniform Push { RouteLinksConstants constants; };

layout(constant_id = 0) const uint CAPACITY = 16;
#include "layer_link.glsl"
#include "receiver.glsl"

// The nearest layer in front of a receiver of light that travels along (sign 1) or against (-1) the direction, at most
// `limit` deep that way; -1 if there is none. Depths are signed that way too.
int nearest_in_front(uint pixel, float sign, float limit) {
  const uint wanted = sign > 0.0 ? SENDS_ALONG : 0u, count = min(filled[pixel], CAPACITY);
  int found = -1;
  float nearest = -NO_LAYER;
  for (uint k = 0u; k < count; ++k) {
    const uvec2 layer = layers[pixel * CAPACITY + k];
    const float depth = sign * uintBitsToFloat(layer.y);
    if ((layer.x & SENDS_ALONG) == wanted && depth <= limit && depth > nearest) {
      nearest = depth;
      found = int(layer.x & ~SENDS_ALONG);
    }
  }
  return found;
}

void route(uint me, Region region) {
  if (me >= constants.texels) return;
  const PsfView view = region.view;
  const vec4 place = positions[me], p = vec4(place.xyz, 1.0);
  const float size = float(constants.size), pixel_width = 2.0 / size;
  const vec2 projected = vec2(dot(view.right, p), dot(view.up, p));
  const vec2 in_pixels = (projected * 0.5 + 0.5) * size;
  const ivec2 nearest = ivec2(in_pixels);
  const vec2 within = in_pixels - vec2(nearest) - 0.5;  // of the nearest centre
  const ivec2 first = nearest + ivec2(within.x < 0.0 ? -1 : 0, within.y < 0.0 ? -1 : 0);
  const ivec2 low = clamp(first, ivec2(0), ivec2(size) - 1), high = clamp(first + 1, ivec2(0), ivec2(size) - 1);
  if (any(lessThan(low, region.rect.xy)) || any(greaterThanEqual(high, region.rect.xy + region.rect.zw))) return;

  const Receiver receiver = receivers[me];
  const vec3 n = receiver.normal.xyz, face = receiver.face_and_triangle.xyz;
  // Of the pair the direction whose light it receives: `sign` times the region's.
  const float sign = dot(face, view.direction.xyz) > 0.0 ? -1.0 : 1.0;
  const vec3 travel = sign * view.direction.xyz;
  const float face_cosine = -dot(face, travel);
  const uint pair = uint(region.place.z) - constants.first_pair;
  if (face_cosine <= 0.0 || dot(n, travel) >= 0.0) {
    put_link(pair, me, UNKNOWN(constants.texels));
    return;
  }
  const vec3 right = normalize(view.right.xyz), up = normalize(view.up.xyz);
  const vec2 slope = vec2(dot(face, right), dot(face, up)) / face_cosine;  // of the depth along `travel`
  const float depth = sign * dot(view.along, p), scale = length(view.along.xyz);
  const float tolerance = receiver_tolerance(slope, pixel_width);
  const float margin = wall_margin(pixel_width, face_cosine * scale);
  int link = -1;
  bool known = false;
  // As in stencil_routing: of the 2 x 2 pixels the nearest that tells what the texel sees.
  for (uint choice = 0u; choice < 8u; ++choice) {
    const ivec2 pixel = clamp(nearest + beside_nearest(choice % 4u, within), ivec2(0), ivec2(size) - 1);
    const vec2 shift = (vec2(pixel) + 0.5) * pixel_width - 1.0 - projected;
    const float own_depth = receiver_depth(shift, depth, slope);
    const vec3 away = (right * shift.x + up * shift.y + travel * (own_depth - depth)) / scale;
    if (wall_between(receiver.near, uint(receiver.face_and_triangle.a), p.xyz, away, face, margin, choice >= 4u))
      continue;
    known = true;
    const ivec2 stored = pixel - region.rect.xy + region.place.xy;
    link = nearest_in_front(uint(stored.y) * constants.store_width + uint(stored.x), sign, own_depth + tolerance);
    if (link >= 0) break;
    const uint texel = uint(place.w), width = uint(imageSize(position).x);
    if (chart_reaches(ivec2(texel % width, texel / width), p.xyz, away)) break;
  }
  put_link(pair, me, link >= 0 ? uint(link) : known ? MISS(constants.texels) : UNKNOWN(constants.texels));
  if (link < 0) {
    if (known) atomicAdd(counters.misses, 1u);
    else atomicAdd(counters.unknown, 1u);
  }
}

void main() {
  const RouteJob job = jobs[constants.first_job + gl_WorkGroupID.x];
  const Region region = regions[job.region];
  for (uint entry = job.first; entry < job.end; ++entry)
    route(tiles[entry] * gl_WorkGroupSize.x + gl_LocalInvocationID.x, region);
}
