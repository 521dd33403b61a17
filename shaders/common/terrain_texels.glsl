// The ground, one texel per wave cell: signed distance to the nearest obstacle [m], its gradient (x, z), still depth
// [m]: 0 on dry ground, minus the height above the water inside an obstacle. Written by the host (sim_setup/basin.cpp).
#ifndef SPINDRIFT_TERRAIN_TEXELS
#define SPINDRIFT_TERRAIN_TEXELS

#include "shared/bindings.h"

layout(binding = TERRAIN) uniform samplerBuffer terrain;

#endif
