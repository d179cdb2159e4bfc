// Histogram of log2 luminance over the valid texels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "luminance.glsl"

layout(local_size_x = SIDE, local_size_y = SIDE) in;
layout(binding = 0, rgba32f) uniform readonly image2D radiance;
layout(binding = 1, rgba32f) uniform readonly image2D position;
layout(binding = 2) buffer Histogram { uint bins[HISTOGRAM_BINS]; };

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(radiance))) || imageLoad(position, texel).a == 0.0) return;
  const float light = log2(max(luminance(imageLoad(radiance, texel).rgb), 1e-30));
  const float bin = (light - LOG_LUMINANCE_MIN) / (LOG_LUMINANCE_MAX - LOG_LUMINANCE_MIN) * float(HISTOGRAM_BINS);
  atomicAdd(bins[uint(clamp(bin, 0.0, float(HISTOGRAM_BINS - 1u)))], 1u);
}
