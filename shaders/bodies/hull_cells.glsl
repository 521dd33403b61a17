// Cells under a hull.
#ifndef SPINDRIFT_HULL_CELLS
#define SPINDRIFT_HULL_CELLS

#include "bodies/boat.glsl"
#include "wave/wave_cell.glsl"
#if VARIED
#include "common/terrain_texels.glsl"
#endif

vec2 inHull(BoatState b, vec2 d) { return vec2(dot(d, forwardOf(b.heading)), dot(d, starboardOf(b.heading))); }

/// Index of a cell, or -1 if it is outside or never holds water.
int wetCell(ivec2 cell) {
#if WAVE
  const ivec2 n = waveCounts();
#if WAVE_PERIODIC_X
  cell.x = wrapped(cell.x, n.x);
#endif
#if WAVE_PERIODIC_Z
  cell.y = wrapped(cell.y, n.y);
#endif
  if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, n))) return -1;
  const int i = cell.x + n.x * cell.y;
#if VARIED && !NONLINEAR
  if (texelFetch(terrain, i).w <= 0.0) return -1;
#endif
  return i;
#else
  return 0;
#endif
}

#if MOVED
/// Still depth; negative on ground above the rest level. [m]
float depthAt(int i) {
#if VARIED
  return texelFetch(terrain, i).w;
#else
  return sim.wave_depth_m;
#endif
}

/// Head of a hull that is moved from outside at d from its centre, cell i. [m]
float movedHeadAt(BoatState b, vec2 half_m, vec2 d, int i) { return movedHead(b, half_m, inHull(b, d), depthAt(i)); }
#endif

#endif
