// The stencil-routed A-buffer: layer k is sample k % SAMPLES of routed pass k / SAMPLES.
layout(constant_id = 2) const uint SAMPLES = 4;
layout(binding = 0) uniform sampler2DMSArray abuffer;
vec4 abuffer_layer(ivec2 pixel, uint size, uint k) {
  return texelFetch(abuffer, ivec3(pixel, k / SAMPLES), int(k % SAMPLES));
}
uint abuffer_filled(ivec2 pixel, uint size) { return LAYERS; }  // unused samples keep NO_LAYER
