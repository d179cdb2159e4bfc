// The rest of the links, of 16 bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#include "shared.h"
#include "links.glsl"
#include "put_link_16.glsl"
#include "route_rest.glsl"
