// Wave cells and their neighbours. WAVE_PERIODIC_X and WAVE_PERIODIC_Z are 1 (wraps) or 0 (the cell outside mirrors the one
// inside).
#ifndef SPINDRIFT_WAVE_CELL
#define SPINDRIFT_WAVE_CELL

#include "shared/sim_uniforms.h"

/// Cells along x and z.
ivec2 waveCounts() { return ivec2(int(sim.wave_nx), int(sim.wave_nz)); }

/// Half the length and half the width of the water. [m]
vec2 waveHalf_m() { return 0.5 * vec2(sim.wave_length_m, sim.wave_width_m); }

/// Precondition: -n <= i < 2 n.
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
  return (vec2(cell) + 0.5) * sim.wave_cell_m - waveHalf_m();
}

/// Shortest way across periodic sides; the plain difference otherwise. [m]
vec2 acrossSides(vec2 d_m) {
#if WAVE_PERIODIC_X
  d_m.x -= sim.wave_length_m * round(d_m.x / sim.wave_length_m);
#endif
#if WAVE_PERIODIC_Z
  d_m.y -= sim.wave_width_m * round(d_m.y / sim.wave_width_m);
#endif
  return d_m;
}

#endif
