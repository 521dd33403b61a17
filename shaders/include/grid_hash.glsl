// Positions to cells and cells to ranges of the sorted particles. Cells have edge H; a row of three x-neighbours is one
// contiguous range, so the 27 cells around a particle are nine ranges. A periodic x side adds a second segment to rows
// that wrap. PERIODIC_X and PERIODIC_Z are 0 or 1.
#ifndef SPINDRIFT_GRID_HASH
#define SPINDRIFT_GRID_HASH

#include "shared/sim_uniforms.h"

/// The grid in registers: loops must not touch the uniform block.
struct Grid {
  vec3 min_m;
  vec3 side_m;
  float cell_m;
  ivec3 cells;
};

Grid loadGrid() {
  Grid g;
  g.min_m = vec3(sim.min_x_m, sim.min_y_m, sim.min_z_m);
  g.side_m = vec3(sim.max_x_m, sim.max_y_m, sim.max_z_m) - g.min_m;
  g.cell_m = sim.support_radius_m;
  g.cells = ivec3(sim.cells_x, sim.cells_y, sim.cells_z);
  return g;
}

/// Cell of a position, clamped to the grid (also for a NaN, which lands in a cell and is counted by diagnostics).
ivec3 cellOf(Grid g, vec3 position_m) {
  const vec3 c = floor((position_m - g.min_m) / g.cell_m);
  return ivec3(clamp(c, vec3(0.0), vec3(g.cells - 1)));
}

int flatCell(Grid g, ivec3 cell) {
  return cell.x + g.cells.x * (cell.y + g.cells.y * cell.z);
}

/// A run of sorted particles, and what to add to one's own position so that distances to them are right across a
/// periodic side. Empty when first == last.
struct CandidateRange {
  int first;
  int last;
  vec3 shift_m;
};

/// How many segments the rows around a cell have: 2 where they wrap around a periodic x side.
int rowSegments(Grid g, ivec3 cell) {
#if PERIODIC_X
  return cell.x == 0 || cell.x == g.cells.x - 1 ? 2 : 1;
#else
  return 1;
#endif
}

/// Cells of segment 0..rowSegments-1 of the row at (dy, dz) in -1..1, as [first, last), before the start lookup.
CandidateRange rowCells(Grid g, ivec3 cell, int dy, int dz, int segment) {
  CandidateRange r;
  r.shift_m = vec3(0.0);
  const int y = cell.y + dy;
  int z = cell.z + dz;
  bool inside = y >= 0 && y < g.cells.y;
#if PERIODIC_Z
  if (z < 0) { z += g.cells.z; r.shift_m.z = g.side_m.z; }
  else if (z >= g.cells.z) { z -= g.cells.z; r.shift_m.z = -g.side_m.z; }
#else
  inside = inside && z >= 0 && z < g.cells.z;
#endif
  int x0 = max(cell.x - 1, 0);
  int x1 = min(cell.x + 1, g.cells.x - 1);
#if PERIODIC_X
  if (segment == 1) {
    const bool left = cell.x == 0;
    x0 = left ? g.cells.x - 1 : 0;
    x1 = x0;
    r.shift_m.x = left ? g.side_m.x : -g.side_m.x;
  }
#endif
  const int base = g.cells.x * (y + g.cells.y * z);
  r.first = inside ? base + x0 : 0;
  r.last = inside ? base + x1 + 1 : 0;
  return r;
}

#endif
