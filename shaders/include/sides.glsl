// What happens to a particle at the sides of its domain.
#ifndef SPINDRIFT_SIDES
#define SPINDRIFT_SIDES

#include "shared/sim_uniforms.h"

/// One axis with walls: stops at the wall and turns the normal speed round.
void keepBetweenWalls(inout float x, inout float v, float low, float high) {
  if (x < low) { x = low; v = abs(v) * sim.wall_restitution; }
  if (x > high) { x = high; v = -abs(v) * sim.wall_restitution; }
}

/// One periodic axis: leaves on one side, enters slightly inside the other.
void wrapAround(inout float x, float low, float high) {
  if (x < low) x = high - sim.reentry_m;
  else if (x >= high) x = low + sim.reentry_m;
}

#endif
