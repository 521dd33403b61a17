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
      // With its own speed: what rises to meet it would push itself, and more than its own weight where much falls.
      absorb(x.xz, max(-v.y, 0.0));
      return false;
    }
    x.y -= gap_m;  // thrown out by the water below
  }
#else
  if (gap_m < sim.floor_gap_m) {
    // Lift to the floor in the column, so that a slope cannot push the particle across a side; the velocity loses what
    // points into the floor along its normal.
    x.y += sim.floor_gap_m - gap_m;
    v -= normal * min(dot(v - floor_velocity_mps, normal), 0.0);
  }
#endif
  keepBetweenWalls(x.y, v.y, sim.min_y_m, sim.max_y_m);
#endif
  return true;
}

#endif
