// The map's log-average luminance and its white, from the histogram. Bin 0, the black, takes no part in either.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(local_size_x = 1) in;
layout(binding = 0) readonly buffer Histogram { uint bins[HISTOGRAM_BINS]; };
layout(binding = 1) writeonly buffer Exposure { float average, white; };  // [W m^-2 sr^-1]

float luminance_of(float bin) {
  return exp2(LOG_LUMINANCE_MIN + (bin + 0.5) * (LOG_LUMINANCE_MAX - LOG_LUMINANCE_MIN) / float(HISTOGRAM_BINS));
}

void main() {
  float texels = 0.0, sum = 0.0;
  uint brightest = 0u;
  for (uint bin = 1u; bin < HISTOGRAM_BINS; ++bin) {
    texels += float(bins[bin]);
    sum += float(bins[bin]) * float(bin);
    if (bins[bin] > 0u) brightest = bin;
  }
  average = texels > 0.0 ? luminance_of(sum / texels) : 1.0;
  white = texels > 0.0 ? luminance_of(float(brightest)) : 1.0;
}
