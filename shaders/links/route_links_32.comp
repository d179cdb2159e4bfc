// Links of 32 bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"
#include "links.glsl"
#include "put_link_32.glsl"
#include "route_links.glsl"
