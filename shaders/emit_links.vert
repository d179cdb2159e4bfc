// Sees the scene along a pair's direction, one region of its raster an instance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(location = 0) in vec3 position;
layout(location = 2) in vec2 atlas;
layout(location = 4) in uint body;

layout(push_constant) uniform Push { EmitLinksConstants constants; };
layout(binding = 0) readonly buffer Offsets { vec4 offsets[]; };  // of each body [m]
layout(binding = 1) readonly buffer Regions { Region regions[]; };

// Of a pixel: Vulkan's usual subPixelPrecisionBits.
const float SUBPIXELS = 256.0;

layout(location = 0) out vec2 atlas_coordinate;
layout(location = 1) out float psf_depth;
out gl_PerVertex {
  vec4 gl_Position;
  float gl_ClipDistance[4];
};

void main() {
  const vec4 p = vec4(position + offsets[body].xyz, 1.0);
  const Region region = regions[gl_InstanceIndex];
  atlas_coordinate = atlas;
  psf_depth = dot(region.view.along, p);
  const vec2 projected = (vec2(dot(region.view.right, p), dot(region.view.up, p)) * 0.5 + 0.5) * float(constants.size);
  // To where the rasteriser would snap it anyway: so that a region looks the same wherever it lies in the store.
  const vec2 pixel = round(projected * SUBPIXELS) / SUBPIXELS;
  const vec2 inside = pixel - vec2(region.rect.xy), beyond = vec2(region.rect.zw) - inside;
  gl_ClipDistance[0] = inside.x;
  gl_ClipDistance[1] = inside.y;
  gl_ClipDistance[2] = beyond.x;
  gl_ClipDistance[3] = beyond.y;
  const vec2 in_store = inside + vec2(region.place.xy);
  gl_Position = vec4(in_store / vec2(constants.store_width, constants.store_height) * 2.0 - 1.0, 0.5, 1.0);
}
