// One layer of the stencil-routed A-buffer: the stencil test decides which sample of the pixel takes it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "emitted.glsl"

layout(location = 0) in vec2 atlas_coordinate;
layout(location = 1) in float psf_depth;
layout(binding = 1) uniform sampler2D radiance;
layout(location = 0) out vec4 layer;  // rgb: radiance [W m^-2 sr^-1]; a: depth

void main() { layer = emitted(radiance, atlas_coordinate, psf_depth, gl_FrontFacing); }
