// Rays of texels along a pair's two directions. Bindings 0, 1, 3, 5 to 9 and 11 to 14 are of what else its shaders include
// (layers_in_front.glsl, put_link_16.glsl and put_link_32.glsl, relink.glsl) and of themselves.

layout(local_size_x_id = 1) in;  // a tile
layout(binding = 2) uniform usamplerBuffer regions;    // rows.glsl
layout(binding = 4) uniform usamplerBuffer receivers;  // of each valid texel, likewise
layout(binding = 10) buffer Counted { Counters counters; };
layout(push_constant) uniform Push { RouteLinksConstants constants; };

// Rays that are not done with are listed by texel and region, once from route_links to route_doubts (`doubts`) and once
// from there to route_rest (`rest`). What is known of such a ray stands in its region's number: no layer was found; a wall
// stands before the nearest pixel.
const uint NOTHING_SEEN = 0x80000000u, WALL_BETWEEN = 0x40000000u;
#include "rows.glsl"

// A texel before a region's raster.
struct Sight {
  vec2 projected;  // in PSF coordinates
  ivec2 nearest;   // pixel
  vec2 within;     // of the texel, from the nearest pixel's centre [pixels]
  bool inside;     // all that it may look at is in the region
  float sign;      // 1: light that it receives travels along the pair's direction; -1: against it
  vec3 travel;     // unit, of that light
  float face_cosine;
  float depth;     // along `travel`
  float scale;     // of metres to PSF coordinates
  vec2 slope;      // of its plane's depth along right and up
};

Sight look(vec3 at, vec3 face, Region region) {
  const PsfView view = region.view;
  const float size = float(constants.size);
  const vec4 p = vec4(at, 1.0);
  Sight sight;
  sight.projected = vec2(dot(view.right, p), dot(view.up, p));
  const vec2 in_pixels = (sight.projected * 0.5 + 0.5) * size;
  const ivec2 last = ivec2(size) - 1;
  sight.nearest = clamp(ivec2(in_pixels), ivec2(0), last);
  sight.within = in_pixels - vec2(sight.nearest) - 0.5;
  const ivec2 first = sight.nearest + ivec2(sight.within.x < 0.0 ? -1 : 0, sight.within.y < 0.0 ? -1 : 0);
  const ivec2 low = clamp(first, ivec2(0), last), high = clamp(first + 1, ivec2(0), last);
  sight.inside =
      all(greaterThanEqual(low, region.rect.xy)) && all(lessThan(high, region.rect.xy + region.rect.zw));
  sight.sign = dot(face, view.direction.xyz) > 0.0 ? -1.0 : 1.0;
  sight.travel = sight.sign * view.direction.xyz;
  sight.face_cosine = -dot(face, sight.travel);
  sight.depth = sight.sign * dot(view.along, p);
  sight.scale = length(view.along.xyz);
  sight.slope = vec2(dot(face, view.right.xyz), dot(face, view.up.xyz)) / (sight.scale * sight.face_cosine);
  return sight;
}

// From the texel to a pixel's centre, in PSF coordinates.
vec2 shift_to(ivec2 pixel, Sight sight) {
  return (vec2(pixel) + 0.5) * (2.0 / float(constants.size)) - 1.0 - sight.projected;
}

// The same in the texel's plane [m].
vec3 away_to(vec2 shift, Sight sight, Region region) {
  const vec3 across = region.view.right.xyz * shift.x + region.view.up.xyz * shift.y;
  return (across / sight.scale + sight.travel * dot(shift, sight.slope)) / sight.scale;
}
