// Finds a receiver's layer among those of a pixel, in the order of arrival, by --sort.
// Included by a shader that defines LAYERS, SORT, abuffer_layer() and abuffer_filled().

float depths[LAYERS];
uint order[LAYERS];

void compare_and_swap(uint a, uint b) {
  if (depths[a] <= depths[b]) return;
  const float depth = depths[a];
  depths[a] = depths[b];
  depths[b] = depth;
  const uint layer = order[a];
  order[a] = order[b];
  order[b] = layer;
}

// Batcher 1968: a network for any power of two.
void sort_bitonic(uint padded) {
  for (uint width = 2u; width <= padded; width *= 2u)
    for (uint stride = width / 2u; stride > 0u; stride /= 2u)
      for (uint a = 0u; a < padded; ++a) {
        const uint b = a ^ stride;
        if (b <= a) continue;
        if ((a & width) == 0u) compare_and_swap(a, b);
        else compare_and_swap(b, a);
      }
}

void sort_compare_swap(uint filled) {
  for (uint last = filled; last > 1u; --last)
    for (uint a = 0u; a + 1u < last; ++a) compare_and_swap(a, a + 1u);
}

// The layer nearest to the receiver among those at most `limit` deep; LAYERS if there is none.
uint last_in_front(ivec2 pixel, uint size, float limit) {
  const uint filled = abuffer_filled(pixel, size);
  uint found = LAYERS;
  if (SORT == SORT_SCAN) {
    float nearest = -NO_LAYER;
    for (uint k = 0u; k < filled; ++k) {
      const float depth = abuffer_layer(pixel, size, k).a;
      if (depth <= limit && depth > nearest) {
        nearest = depth;
        found = k;
      }
    }
    return found;
  }
  const uint sorted = SORT == SORT_BITONIC ? LAYERS : filled;
  for (uint k = 0u; k < sorted; ++k) {
    depths[k] = k < filled ? abuffer_layer(pixel, size, k).a : NO_LAYER;
    order[k] = k;
  }
  if (SORT == SORT_BITONIC) sort_bitonic(LAYERS);
  else sort_compare_swap(filled);
  for (uint k = 0u; k < sorted && depths[k] <= limit; ++k) found = order[k];
  return found;
}
