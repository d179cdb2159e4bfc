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

// How near a wall the rasteriser may have put a pixel's centre on either side [m]; `scale`: of PSF coordinates to metres
// along the receiver's plane.
float wall_margin(float pixel_width, float scale) { return 2.0 * SUBPIXEL * pixel_width / scale; }

#endif
