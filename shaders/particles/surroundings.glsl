// Collisions of a particle at the end of its step: the sides of its domain, hulls, rocks, the floor; in two-way scenes
// the surface, which absorbs it.
#ifndef SPINDRIFT_SURROUNDINGS
#define SPINDRIFT_SURROUNDINGS

#include "particles/floor.glsl"
#include "particles/sides.glsl"
#if POOL_PARTICLES
#include "coupling/absorption.glsl"
#endif
#if COUPLED && VARIED
#include "common/terrain.glsl"
#endif
#if HULLS
#include "bodies/hull.glsl"
#endif

/// Moves x and v to allowed values. Returns false if the particle has become water.
bool meetSurroundings(inout vec3 x, inout vec3 v) {
  keepInside(x, v);
#if HULLS
  pushOutOfHulls(x, v);
#endif
#if COUPLED && VARIED
  pushOutOfRocks(x, v);
#endif
#if HULLS || (COUPLED && VARIED)
  keepInside(x, v);  // a hull near a side may have pushed it across
#endif

#if !PERIODIC_Y
  const Floor f = loadFloor();
  vec3 normal;
  vec3 floor_velocity_mps;
  const float gap_m = x.y - floorState(f, x.xz, normal, floor_velocity_mps);
#if POOL_PARTICLES
  if (gap_m < 0.0) {
    const float approach_mps = floor_velocity_mps.y - v.y;
    if (approach_mps > 0.0 || gap_m < -sim.spacing_m) {
      // Only the particle's own velocity counts: with that of the rising surface, the surface would push itself, by more
      // than its weight where much water falls.
      absorb(x.xz, v);
      return false;
    }
    x.y -= gap_m;  // the water below throws it out
  }
#else
  if (gap_m < sim.floor_gap_m) {
    // Lift the particle to the floor vertically, so that a slope cannot push it across a side, and remove the component
    // of its velocity into the floor.
    x.y += sim.floor_gap_m - gap_m;
    v -= normal * min(dot(v - floor_velocity_mps, normal), 0.0);
  }
#endif
  keepBetweenWalls(x.y, v.y, sim.min_y_m, sim.max_y_m);
#endif
  return true;
}

#endif
