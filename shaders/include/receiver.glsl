// A texel as a receiver of one PSF's light: its plane in PSF coordinates, what stands on it, how far its chart reaches.
// Included by a shader that has the image `position` (xyz [m]; a: 1 on valid texels), `walls_first` and `walls`.

#include "receiver_plane.glsl"

// Of the 2 x 2 pixels around a texel, the nearest first, how far each is from the nearest; `within`: of the texel, from the
// nearest's centre [pixels].
ivec2 beside_nearest(uint attempt, vec2 within) {
  const bool far_x = attempt == 3u || attempt == (abs(within.x) > abs(within.y) ? 1u : 2u);
  const bool far_y = attempt == 3u || attempt != 0u && !far_x;
  return ivec2(far_x ? (within.x < 0.0 ? -1 : 1) : 0, far_y ? (within.y < 0.0 ? -1 : 1) : 0);
}

// The step from a texel to its neighbour in x or y on the same chart [m]; zero if it has none there.
vec3 texel_step(ivec2 texel, vec3 p, ivec2 by) {
  const ivec2 after = min(texel + by, imageSize(position) - 1), before = max(texel - by, ivec2(0));
  const vec4 next = imageLoad(position, after), last = imageLoad(position, before);
  if (next.a > 0.0 && after != texel) return next.xyz - p;
  return last.a > 0.0 && before != texel ? p - last.xyz : vec3(0.0);
}

// Whether the chart of the texel at p surely still is there `away` from it, a vector in its plane [m]: between centres of
// valid texels that lie where they should.
bool chart_reaches(ivec2 texel, vec3 p, vec3 away) {
  const vec3 x = texel_step(texel, p, ivec2(1, 0)), y = texel_step(texel, p, ivec2(0, 1));
  const float xx = dot(x, x), xy = dot(x, y), yy = dot(y, y), determinant = xx * yy - xy * xy;
  if (determinant <= 1e-6 * xx * yy) return false;
  const vec2 along = vec2(dot(x, away), dot(y, away));
  const vec2 texels = vec2(yy * along.x - xy * along.y, xx * along.y - xy * along.x) / determinant;
  const vec2 at = floor(vec2(texel) + texels), last = vec2(imageSize(position) - 1);
  if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, last))) return false;
  for (int corner = 0; corner < 4; ++corner) {
    const vec4 there = imageLoad(position, ivec2(at) + ivec2(corner & 1, corner >> 1));
    if (there.a == 0.0 || distance(there.xyz, p + away) > sqrt(xx) + sqrt(yy)) return false;
  }
  return true;
}

#include "wall.glsl"

// Whether a surface leaves the receiver's plane between p and what is `away` from it: one that rises from it, or any.
// `near`: the receiver's two nearest walls, and the distances of the first and of the third, as bits [m].
bool wall_between(uvec4 near, uint triangle, vec3 p, vec3 away, vec3 face, Blur blur, bool rising_only) {
  const float reach = length(away) + most_blur(blur);
  if (reach < uintBitsToFloat(near.z)) return false;
  if (is_between(near.x, p, away, face, blur, rising_only)) return true;
  if (reach < uintBitsToFloat(near.w)) return is_between(near.y, p, away, face, blur, rising_only);
  for (uint wall = walls_first[triangle]; wall < walls_first[triangle + 1u]; ++wall)
    if (is_between(wall, p, away, face, blur, rising_only)) return true;
  return false;
}
