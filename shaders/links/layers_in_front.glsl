// The A-buffer of texel numbers that rays look into. Included after link_rays.glsl.

layout(constant_id = 0) const uint CAPACITY = 16;
layout(binding = 0) readonly buffer Layers { uvec2 layers[]; };
layout(binding = 1) readonly buffer Filled { uint filled[]; };
#include "layer_link.glsl"

// The nearest layer of a pixel in front of a receiver, at most `limit` deep along the light that it receives; -1 if there
// is none. Layers that are not asked for, where `wanted` is false.
int nearest_in_front(ivec2 pixel, Region region, float sign, float limit, bool wanted) {
  const ivec2 within = pixel - region.rect.xy;
  const uint index = uint(region.store.w + within.y * region.rect.z + within.x);
  const uint counts = wanted ? filled[index] : 0u;
  const bool along = sign > 0.0;
  const uint count = min(layers_of(counts, along), CAPACITY);
  int found = -1;
  float nearest = -NO_LAYER;
  for (uint k = 0u; k < count; ++k) {
    const uvec2 layer = layers[slot_of(k, along, CAPACITY) * constants.store_pixels + index];
    const float depth = sign * uintBitsToFloat(layer.y);
    if (depth <= limit && depth > nearest) {
      nearest = depth;
      found = int(layer.x);
    }
  }
  return found;
}
