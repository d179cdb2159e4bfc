#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(constant_id = 0) const uint LAYERS = 8;
layout(constant_id = 1) const uint SORT = SORT_COMPARE_SWAP;
#include "abuffer_list.glsl"
#include "routing.glsl"
