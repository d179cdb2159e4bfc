// A receiver's plane in PSF coordinates, and how far the rasteriser may be off it.
#ifndef RECEIVER_PLANE_GLSL
#define RECEIVER_PLANE_GLSL

// Layers are sampled at pixel centres, so the receiver's depth is taken there too: where the ray through the centre
// meets the receiver's plane. Shifts in PSF coordinates; `slope` is the plane's change of depth along right and up.
float receiver_depth(vec2 shift, float depth, vec2 slope) { return depth + dot(shift, slope); }

// What the rasteriser may be off by: vertices are snapped to 1/256 pixel (Vulkan's usual subPixelPrecisionBits), which
// moves a plane's depth by as much of its slope; and rounding of 32-bit depths.
const float SUBPIXEL = 1.0 / 256.0;
const float ROUNDING = 1e-5;
float receiver_tolerance(vec2 slope, float pixel) { return SUBPIXEL * pixel * (abs(slope.x) + abs(slope.y)) + ROUNDING; }

// How far the rasteriser may have put a centre from its place in the receiver's plane: `snapped` across the view [m], and
// farther the more a direction in the plane leads along the light. `travel`: of the light; scale: of metres to PSF
// coordinates.
struct Blur {
  float snapped;
  vec3 steep;
};
Blur blur_of(float pixel_width, float scale, vec3 travel, float face_cosine) {
  return Blur(2.0 * SUBPIXEL * pixel_width / scale, travel / face_cosine);
}
// In a direction in the plane (unit); in any.
float blur_along(vec3 direction, Blur blur) {
  const float rise = dot(direction, blur.steep);
  return blur.snapped * sqrt(1.0 + rise * rise);
}
float most_blur(Blur blur) { return blur.snapped * length(blur.steep); }

#endif
