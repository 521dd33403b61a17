// Pressure on the surface (hulls, falling particles), as a height of water.
#ifndef SPINDRIFT_PRESSURE_HEAD
#define SPINDRIFT_PRESSURE_HEAD

#include "shared/bindings.h"

#if HEAD
layout(binding = PRESSURE_HEAD) uniform isamplerBuffer pressure_head;
#endif

/// [units]; 0 in scenes in which nothing presses.
int headAt(int i) {
#if HEAD
  return texelFetch(pressure_head, i).x;
#else
  return 0;
#endif
}

#endif
