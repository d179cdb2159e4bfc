// The map's log-average luminance and its white, from the histogram. Bin 0, the black, takes no part in either.
// The average leaves out the darkest and the brightest tenth: a few texels beneath a block, dark by many powers of two,
// must not change how bright everything else is shown. From the last map's exposure it goes there as an eye does, by a
// share of the way in powers of two.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(local_size_x = 1) in;
layout(binding = 0) readonly buffer Histogram { uint bins[HISTOGRAM_BINS]; };
layout(binding = 1) buffer Exposures { Exposure exposure; };
layout(push_constant) uniform Push { ExposureConstants constants; };

float luminance_of(float bin) {
  return exp2(LOG_LUMINANCE_MIN + (bin + 0.5) * (LOG_LUMINANCE_MAX - LOG_LUMINANCE_MIN) / float(HISTOGRAM_BINS));
}

const float WHITE_OF_FIXED = 64.0;  // times the average
const float CLOSE = 0.01;           // powers of two that nobody sees
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
  float average = lit > 0.0 ? luminance_of(sum / texels) : 1.0;
  float white = lit > 0.0 ? luminance_of(float(brightest)) : 1.0;
  if (constants.fixed_average > 0.0) {
    average = constants.fixed_average;
    white = WHITE_OF_FIXED * average;
  }
  const vec2 last = log2(max(vec2(exposure.average, exposure.white), 1e-30)), own = log2(vec2(average, white));
  const float kept = own.x > last.x ? constants.brighter : constants.darker;
  const vec2 next = mix(own, last, kept);
  const bool arrived = exposure.average <= 0.0 || all(lessThan(abs(next - own), vec2(CLOSE)));
  exposure.average = exp2(arrived ? own.x : next.x);
  exposure.white = exp2(arrived ? own.y : next.y);
  exposure.adapted = arrived ? 1u : 0u;
}
