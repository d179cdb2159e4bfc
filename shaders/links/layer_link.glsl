// A pixel's list holds what sends light along the pair's direction from its front on, and what sends it the other way from
// its end back, so that a receiver reads half of it. Both are counted in one word. The n-th layers of all pixels lie
// together: most pixels fill few of their slots.
const uint SENDS_ALONG = 1u, SENDS_BACK = 0x10000u;
uint layers_of(uint counts, bool along) { return along ? counts & 0xffffu : counts >> 16u; }
uint layers_of_both(uint counts) { return layers_of(counts, true) + layers_of(counts, false); }
uint slot_of(uint nth, bool along, uint capacity) { return along ? nth : capacity - 1u - nth; }

// A layer: the texel that is seen there, and its depth.
uvec2 layer_link(uint texel, float depth) { return uvec2(texel, floatBitsToUint(depth)); }
