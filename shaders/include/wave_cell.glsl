// Wave cells and their neighbours. WAVE_PERIODIC is 1 (wraps) or 0 (reflects: the cell outside mirrors the one inside).
#ifndef SPINDRIFT_WAVE_CELL
#define SPINDRIFT_WAVE_CELL

#include "shared/sim_uniforms.h"

int waveNeighbour(int i, int n) {
#if WAVE_PERIODIC
  return i < 0 ? i + n : (i >= n ? i - n : i);
#else
  return clamp(i, 0, n - 1);
#endif
}

/// Centre of a cell. [m]
vec2 waveCellCentre(ivec2 cell) {
  return (vec2(cell) + 0.5) * sim.wave_cell_m - 0.5 * sim.wave_side_m;
}

#endif
