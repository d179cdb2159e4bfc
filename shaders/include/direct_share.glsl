// A lamp's share of a texel's direct light, w Le of one channel; `lamp`: its Le [scaled]; direction: xyz; w: solid angle [sr].
// To the last bit the same whichever shader computes it.
uint direct_share(float lamp, vec3 normal, vec4 direction) {
  precise const float weight = abs(dot(normal, direction.xyz)) * direction.w;
  precise const float light = weight * lamp;
  return uint(light + 0.5);
}
