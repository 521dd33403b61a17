// Particles at the sides of their domain.
#ifndef SPINDRIFT_SIDES
#define SPINDRIFT_SIDES

#include "particles/floor.glsl"
#include "shared/sim_uniforms.h"

/// One axis with walls: the particle stops at the wall.
void keepBetweenWalls(inout float x, inout float v, float low, float high) {
  if (x < low) { x = low; v = max(v, 0.0); }
  if (x > high) { x = high; v = min(v, 0.0); }
}

/// One periodic axis: the particle leaves on one side and enters slightly inside the other.
void wrapAround(inout float x, float low, float high) {
  if (x < low) x = high - sim.reentry_m;
  else if (x >= high) x = low + sim.reentry_m;
}

#if FOLLOW
/// For a moving patch: particles left behind enter at its front, at the same height above the water and moving with it.
void carryAlong(inout vec3 x, inout vec3 v) {
  const vec2 low = vec2(sim.min_x_m, sim.min_z_m);
  const vec2 side = vec2(sim.max_x_m, sim.max_z_m) - low;
  const vec2 turns = floor((x.xz - low) / side);
  if (turns == vec2(0.0)) return;
  const Floor f = loadFloor();
  const float gap_m = x.y - floorHeight(f, x.xz);
  x.xz = clamp(x.xz - turns * side, low, low + side);
  vec3 normal;
  x.y = floorState(f, x.xz, normal, v) + gap_m;
}
#endif

/// Horizontal axes, and the vertical one where it is periodic.
void keepInside(inout vec3 x, inout vec3 v) {
#if FOLLOW
  carryAlong(x, v);
#else
#if PERIODIC_X
  wrapAround(x.x, sim.min_x_m, sim.max_x_m);
#else
  keepBetweenWalls(x.x, v.x, sim.min_x_m, sim.max_x_m);
#endif
#if PERIODIC_Z
  wrapAround(x.z, sim.min_z_m, sim.max_z_m);
#else
  keepBetweenWalls(x.z, v.z, sim.min_z_m, sim.max_z_m);
#endif
#if PERIODIC_Y
  wrapAround(x.y, sim.min_y_m, sim.max_y_m);
#endif
#endif
}

#endif
