// Sees the scene along a pair's direction, one region of its raster an instance.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require
#include "shared.h"
#include "receiver_plane.glsl"
#include "rows.glsl"

layout(location = 0) in vec3 position;
layout(location = 2) in vec2 atlas;
layout(location = 4) in uint body;

layout(push_constant) uniform Push { EmitLinksConstants constants; };
layout(binding = 0) readonly buffer Offsets { vec4 offsets[]; };  // of each body [m]
layout(binding = 1) uniform usamplerBuffer regions;  // rows.glsl

layout(location = 0) out vec2 atlas_coordinate;
layout(location = 1) out float psf_depth;
layout(location = 2) flat out uvec2 stored;  // where pixel (0, 0) would be in the store, modulo 2^32; columns
out gl_PerVertex { vec4 gl_Position; };

void main() {
  const vec4 p = vec4(position + offsets[body].xyz, 1.0);
  const Region region = region_at(regions, gl_InstanceIndex);
  atlas_coordinate = atlas;
  psf_depth = dot(region.view.along, p);
  stored = uvec2(region.store.w - region.store.y * region.rect.z - region.store.x, region.rect.z);
  // To where the rasteriser would snap it anyway: so that a region looks the same wherever it lies in the store.
  const float steps = 0.5 * float(constants.size) / SUBPIXEL;
  const vec2 projected = vec2(dot(region.view.right, p), dot(region.view.up, p));
  gl_Position = vec4(round((projected + 1.0) * steps) / steps - 1.0, 0.5, 1.0);
  gl_ViewportIndex = int(uint(gl_InstanceIndex) % constants.windows);
}
