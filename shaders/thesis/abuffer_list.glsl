// The per-pixel list: LAYERS slots a pixel, of which the first `filled` are taken.
layout(binding = 0) readonly buffer Layers { vec4 layers[]; };
layout(binding = 1) readonly buffer Filled { uint filled[]; };
vec4 abuffer_layer(ivec2 pixel, uint size, uint k) { return layers[(pixel.y * size + pixel.x) * LAYERS + k]; }
uint abuffer_filled(ivec2 pixel, uint size) { return min(filled[pixel.y * size + pixel.x], LAYERS); }
