// Stencil routing, per texel: order the layers of the pixel that the texel projects to and take the last one in front.
// Included by a shader that defines abuffer_layer() and abuffer_filled() for its kind of A-buffer.

layout(local_size_x = GROUP, local_size_y = GROUP) in;
layout(binding = 2, rgba32f) uniform readonly image2D position;
layout(binding = 3, rgba32f) uniform readonly image2D normal;
layout(binding = 4, rgba32f) uniform readonly image2D face_normal;
layout(binding = 5, rgba32f) uniform writeonly image2D psf_irradiance;  // rgb: w_k L_k [W m^-2]; a: w_k [sr]
layout(binding = 6) buffer Counted { Counters counters; };
layout(push_constant) uniform Push { RoutingConstants constants; };

float depths[LAYERS];
uint order[LAYERS];

void compare_and_swap(uint a, uint b) {
  if (depths[a] <= depths[b]) return;
  const float depth = depths[a];
  depths[a] = depths[b];
  depths[b] = depth;
  const uint place = order[a];
  order[a] = order[b];
  order[b] = place;
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
uint last_in_front(ivec2 pixel, float limit) {
  const uint filled = abuffer_filled(pixel, constants.size);
  uint found = LAYERS;
  if (SORT == SORT_SCAN) {
    float nearest = -NO_LAYER;
    for (uint k = 0u; k < filled; ++k) {
      const float depth = abuffer_layer(pixel, constants.size, k).a;
      if (depth <= limit && depth > nearest) {
        nearest = depth;
        found = k;
      }
    }
    return found;
  }
  const uint sorted = SORT == SORT_BITONIC ? LAYERS : filled;
  for (uint k = 0u; k < sorted; ++k) {
    depths[k] = k < filled ? abuffer_layer(pixel, constants.size, k).a : NO_LAYER;
    order[k] = k;
  }
  if (SORT == SORT_BITONIC) sort_bitonic(LAYERS);
  else sort_compare_swap(filled);
  for (uint k = 0u; k < sorted && depths[k] <= limit; ++k) found = order[k];
  return found;
}

// Layers are sampled at pixel centres, so the receiver's depth is taken there too: where the ray through the centre
// meets the receiver's plane. Shifts in PSF coordinates; `slope` is the plane's change of depth along right and up.
float receiver_depth(vec2 shift, float depth, vec2 slope) { return depth + dot(shift, slope); }

// What the rasteriser may be off by: vertices are snapped to 1/256 pixel (Vulkan's usual subPixelPrecisionBits), which
// moves a plane's depth by as much of its slope; and rounding of 32-bit depths.
const float SUBPIXEL = 1.0 / 256.0;
const float ROUNDING = 1e-5;
float receiver_tolerance(vec2 slope, float pixel) { return SUBPIXEL * pixel * (abs(slope.x) + abs(slope.y)) + ROUNDING; }

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(position)))) return;
  const vec4 p = imageLoad(position, texel);
  const PsfView view = constants.view;
  const vec3 n = imageLoad(normal, texel).xyz;
  const vec3 face = imageLoad(face_normal, texel).xyz;
  const float cosine = -dot(n, view.direction.xyz);
  const float face_cosine = -dot(face, view.direction.xyz);
  if (p.a == 0.0 || cosine <= 0.0 || face_cosine <= 0.0) {
    imageStore(psf_irradiance, texel, vec4(0.0));
    return;
  }
  // On the plane, face . (x - p) = 0; the view's rows have length 1 / radius, their directions are unit vectors.
  const vec2 slope = vec2(dot(face, normalize(view.right.xyz)), dot(face, normalize(view.up.xyz))) / face_cosine;
  const float depth = dot(view.along, p);
  const vec2 projected = vec2(dot(view.right, p), dot(view.up, p));

  // The nearest pixel; where that is empty, the others of the 2 x 2 around the texel, nearest first. A texel at the
  // scene's silhouette may project into a pixel whose centre looks past everything, though its own ray does not.
  const float size = float(constants.size), pixel_width = 2.0 / size;
  const vec2 in_pixels = (projected * 0.5 + 0.5) * size;
  const ivec2 nearest = ivec2(in_pixels);
  const vec2 within = in_pixels - vec2(nearest) - 0.5;
  const ivec2 beside = ivec2(within.x < 0.0 ? -1 : 1, within.y < 0.0 ? -1 : 1);
  const bool across = abs(within.x) > abs(within.y);
  ivec2 pixel;
  uint layer = LAYERS;
  for (uint attempt = 0u; attempt < 4u && layer == LAYERS; ++attempt) {
    const bvec2 step = bvec2(attempt == 3u || attempt == (across ? 1u : 2u), attempt == 3u || attempt == (across ? 2u : 1u));
    pixel = clamp(nearest + ivec2(step) * beside, ivec2(0), ivec2(size) - 1);
    const vec2 centre = (vec2(pixel) + 0.5) * pixel_width - 1.0;
    layer = last_in_front(pixel, receiver_depth(centre - projected, depth, slope) + receiver_tolerance(slope, pixel_width));
  }
  const float weight = cosine * view.direction.w;
  const vec3 radiance = layer < LAYERS ? abuffer_layer(pixel, constants.size, layer).rgb : vec3(0.0);
  imageStore(psf_irradiance, texel, vec4(weight * radiance, weight));
  if (constants.count != 0u) {
    atomicAdd(counters.rays, 1u);
    if (layer == LAYERS) atomicAdd(counters.misses, 1u);
  }
}
