// The map's log-average luminance and its white, from the histogram. Bin 0, the black, takes no part in either.
// The average leaves out the darkest and the brightest tenth: a few texels beneath a block, dark by many powers of two,
// must not change how bright everything else is shown.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(local_size_x = 1) in;
layout(binding = 0) readonly buffer Histogram { uint bins[HISTOGRAM_BINS]; };
layout(binding = 1) writeonly buffer Exposure { float average, white; };  // [W m^-2 sr^-1]

float luminance_of(float bin) {
  return exp2(LOG_LUMINANCE_MIN + (bin + 0.5) * (LOG_LUMINANCE_MAX - LOG_LUMINANCE_MIN) / float(HISTOGRAM_BINS));
}

const float LOWEST = 0.1, HIGHEST = 0.9;  // quantiles of the lit texels

void main() {
  float lit = 0.0;
  uint brightest = 0u;
  for (uint bin = 1u; bin < HISTOGRAM_BINS; ++bin) {
    lit += float(bins[bin]);
    if (bins[bin] > 0u) brightest = bin;
  }
  float below = 0.0, texels = 0.0, sum = 0.0;
  for (uint bin = 1u; bin < HISTOGRAM_BINS; ++bin) {
    const float upto = below + float(bins[bin]);
    const float taken = max(0.0, min(upto, HIGHEST * lit) - max(below, LOWEST * lit));
    texels += taken;
    sum += taken * float(bin);
    below = upto;
  }
  average = lit > 0.0 ? luminance_of(sum / texels) : 1.0;
  white = lit > 0.0 ? luminance_of(float(brightest)) : 1.0;
}
