// Direct light: for each texel and half of the directions the sum of w Le of the lamps that it sees, three channels.
uint direct_at(uint texel, uint half_of, uint channel) { return 3u * (2u * texel + half_of) + channel; }

// A lamp's share of a texel's direct light, w Le of one channel; `lamp`: its Le [scaled]; direction: xyz; w: solid angle
// [sr]. To the last bit the same whichever shader computes it.
uint direct_share(float lamp, vec3 normal, vec4 direction) {
  precise const float weight = abs(dot(normal, direction.xyz)) * direction.w;
  precise const float light = weight * lamp;
  return uint(light + 0.5);
}
