// What a surface sends along the PSF's direction: radiance and depth.

// A double-sided surface sends light backwards too. Its back lies exactly as deep as its own texels, so that it is put
// just behind them: by half a pixel's change of depth and a little for rounding, which is more than a receiver's test
// allows for (receiver_tolerance in receiver_plane.glsl).
const float BACK_ROUNDING = 1e-4;

float back_shift(float depth) { return 0.5 * fwidth(depth) + BACK_ROUNDING; }

vec4 emitted(sampler2D radiance, vec2 atlas_coordinate, float depth, bool front) {
  return vec4(texture(radiance, atlas_coordinate).rgb, depth + (front ? 0.0 : back_shift(depth)));
}
