// A link is the number of the texel that is seen, among the valid ones, or one of these.
uint MISS(uint texels) { return texels; }           // nothing is there
uint UNKNOWN(uint texels) { return texels + 1u; }  // not told by any pixel, or faces neither way: left out of the sum
