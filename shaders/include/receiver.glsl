// A texel as a receiver of one PSF's light: its plane in PSF coordinates, what stands on it, how far its chart reaches.
// Included by a shader that has the image `position` (xyz [m]; a: 1 on valid texels), `walls_first` and `walls`.

// Layers are sampled at pixel centres, so the receiver's depth is taken there too: where the ray through the centre
// meets the receiver's plane. Shifts in PSF coordinates; `slope` is the plane's change of depth along right and up.
float receiver_depth(vec2 shift, float depth, vec2 slope) { return depth + dot(shift, slope); }

// What the rasteriser may be off by: vertices are snapped to 1/256 pixel (Vulkan's usual subPixelPrecisionBits), which
// moves a plane's depth by as much of its slope; and rounding of 32-bit depths.
const float SUBPIXEL = 1.0 / 256.0;
const float ROUNDING = 1e-5;
float receiver_tolerance(vec2 slope, float pixel) { return SUBPIXEL * pixel * (abs(slope.x) + abs(slope.y)) + ROUNDING; }

// Of the 2 x 2 pixels around a texel, the nearest first, how far each is from the nearest; `within`: of the texel, from the
// nearest's centre [pixels].
ivec2 beside_nearest(uint attempt, vec2 within) {
  const bool far_x = attempt == 3u || attempt == (abs(within.x) > abs(within.y) ? 1u : 2u);
  const bool far_y = attempt == 3u || attempt != 0u && !far_x;
  return ivec2(far_x ? (within.x < 0.0 ? -1 : 1) : 0, far_y ? (within.y < 0.0 ? -1 : 1) : 0);
}

// How near a wall the rasteriser may have put a pixel's centre on either side [m]; `scale`: of PSF coordinates to metres
// along the receiver's plane.
float wall_margin(float pixel_width, float scale) { return 2.0 * SUBPIXEL * pixel_width / scale; }

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

// Of the margin: rounding of places in 32 bits.
const float ON_A_WALL = 0.1;

// Whether wall `wall` stands between p and the place `away` from it. Within `margin` of a wall [m] the rasteriser may have
// put a centre on either side.
bool is_between(uint wall, vec3 p, vec3 away, vec3 face, float margin, bool rising_only) {
  const vec4 first = walls[2u * wall];
  if (rising_only && first.w == 0.0) return false;
  const vec3 a = first.xyz, edge = walls[2u * wall + 1u].xyz - a;
  const float width = length(edge);
  if (width == 0.0) return false;
  const vec3 along = edge / width, across = cross(face, along);
  float here = dot(p - a, across), there = here + dot(away, across);
  // A texel on the line itself belongs to its triangle's middle, which is where `across` points.
  if (here < -ON_A_WALL * margin) {
    here = -here;
    there = -there;
  }
  here = max(here, 0.0);
  if (there > min(margin, 0.5 * here)) return false;
  const float share = there < here ? clamp(here / max(here - there, 1e-30), 0.0, 1.0) : 1.0;
  const float place = dot(p + share * away - a, along);
  return place >= -margin && place <= width + margin;
}

// Whether a surface leaves the receiver's plane between p and the place `away` from it: one that rises from it, or any.
// `near`: the receiver's two nearest walls, and the distances of the first and of the third, as bits [m].
bool wall_between(uvec4 near, uint triangle, vec3 p, vec3 away, vec3 face, float margin, bool rising_only) {
  const float reach = length(away) + margin;
  if (reach < uintBitsToFloat(near.z)) return false;
  if (is_between(near.x, p, away, face, margin, rising_only)) return true;
  if (reach < uintBitsToFloat(near.w)) return is_between(near.y, p, away, face, margin, rising_only);
  for (uint wall = walls_first[triangle]; wall < walls_first[triangle + 1u]; ++wall)
    if (is_between(wall, p, away, face, margin, rising_only)) return true;
  return false;
}
