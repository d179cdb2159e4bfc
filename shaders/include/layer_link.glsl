// A layer of a pixel's list: the texel that is seen there, which of the pair's two ways it sends light, and its depth.
const uint SENDS_ALONG = 0x80000000u;
uvec2 layer_link(uint texel, bool along, float depth) {
  return uvec2(texel | (along ? SENDS_ALONG : 0u), floatBitsToUint(depth));
}
