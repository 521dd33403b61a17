// Wave cells and their neighbours. WAVE_PERIODIC_X and WAVE_PERIODIC_Z are 1 (wraps) or 0 (the cell outside mirrors the one
// inside).
#ifndef SPINDRIFT_WAVE_CELL
#define SPINDRIFT_WAVE_CELL

#include "shared/sim_uniforms.h"

int wrapped(int i, int n) {
  return i < 0 ? i + n : (i >= n ? i - n : i);
}

int waveNeighbourX(int i, int n) {
#if WAVE_PERIODIC_X
  return wrapped(i, n);
#else
  return clamp(i, 0, n - 1);
#endif
}

int waveNeighbourZ(int i, int n) {
#if WAVE_PERIODIC_Z
  return wrapped(i, n);
#else
  return clamp(i, 0, n - 1);
#endif
}

/// Centre of a cell. [m]
vec2 waveCellCentre(ivec2 cell) {
  return (vec2(cell) + 0.5) * sim.wave_cell_m - 0.5 * sim.wave_side_m;
}

/// Shortest way across periodic sides; the plain difference otherwise. [m]
vec2 acrossSides(vec2 d_m) {
  const float side_m = sim.wave_side_m;
#if WAVE_PERIODIC_X
  d_m.x -= side_m * round(d_m.x / side_m);
#endif
#if WAVE_PERIODIC_Z
  d_m.y -= side_m * round(d_m.y / side_m);
#endif
  return d_m;
}

#endif
