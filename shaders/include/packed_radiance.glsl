// RGB9E5, as Vulkan's E5B9G9R9 (specification, section 3.11.2): three mantissas of 9 bits share an exponent. A channel
// is off by at most 1/1024 of the brightest one, at random from texel to texel, so that a sum over many is far nearer.
uint pack_radiance(vec3 radiance) {
  const vec3 clamped = clamp(radiance, 0.0, 65408.0);
  const float most = max(clamped.r, max(clamped.g, clamped.b));
  int exponent = max(-16, int(floatBitsToUint(most) >> 23) - 127) + 16;  // of the brightest; its mantissa fills 9 bits
  float scale = exp2(float(24 - exponent));
  if (uint(most * scale + 0.5) == 512u) {
    ++exponent;
    scale *= 0.5;
  }
  const uvec3 mantissas = uvec3(clamped * scale + 0.5);
  return mantissas.r | mantissas.g << 9u | mantissas.b << 18u | uint(exponent) << 27u;
}

vec3 unpack_radiance(uint bits) {
  const float scale = uintBitsToFloat(((bits >> 27u) + 103u) << 23u);  // 2^(exponent - 24)
  return vec3(bits & 511u, bits >> 9u & 511u, bits >> 18u & 511u) * scale;
}
