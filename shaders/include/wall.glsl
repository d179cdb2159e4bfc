// Lines in a receiver's plane where other surfaces leave it. Included after receiver_plane.glsl by a shader that has
// `walls`: two texels a line, its ends [m]; the first's w: 1 if the surface rises.

// Of the blur: rounding of positions in 32 bits.
const float ON_A_WALL = 0.1;

// Whether wall `wall` stands between p and what is `away` from it. Within its blur the rasteriser may have put a centre on
// either side.
bool is_between(uint wall, vec3 p, vec3 away, vec3 face, Blur blur, bool rising_only) {
  const vec4 first = texelFetch(walls, int(2u * wall));
  if (rising_only && first.w == 0.0) return false;
  const vec3 a = first.xyz, edge = texelFetch(walls, int(2u * wall + 1u)).xyz - a;
  const float width = length(edge);
  if (width == 0.0) return false;
  const vec3 along = edge / width, across = cross(face, along);
  const float beside = blur_along(across, blur), beyond = blur_along(along, blur);
  float here = dot(p - a, across), there = here + dot(away, across);
  // A texel on the line itself belongs to its triangle's middle, which is where `across` points.
  if (here < -ON_A_WALL * beside) {
    here = -here;
    there = -there;
  }
  here = max(here, 0.0);
  if (there > min(beside, 0.5 * here)) return false;
  const float share = there < here ? clamp(here / max(here - there, 1e-30), 0.0, 1.0) : 1.0;
  const float along_it = dot(p + share * away - a, along);
  return along_it >= -beyond && along_it <= width + beyond;
}
