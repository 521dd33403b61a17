// Positions to cells, and cells to ranges of the sorted particles. Cells have edge H and are numbered y fastest. y is
// never periodic in a scene with a water surface, so the three y-neighbours of a column are one contiguous range, and
// the 27 cells around a particle are nine ranges without a special case at the sides. In a box that is periodic in y,
// which should be only a few cells high, all particles of a column are candidates. PERIODIC_X, PERIODIC_Y and
// PERIODIC_Z are 0 or 1.
#ifndef SPINDRIFT_GRID_HASH
#define SPINDRIFT_GRID_HASH

#include "common/finite.glsl"
#include "shared/grid.h"
#include "shared/sim_uniforms.h"

/// The grid in registers, so that loops do not read the uniform block.
struct Grid {
  vec3 min_m;
  vec3 side_m;
  float cell_m;
  ivec3 cells;
  int candidates_max;  ///< of one CandidateRange
};

Grid loadGrid() {
  Grid g;
  g.min_m = vec3(sim.min_x_m, sim.min_y_m, sim.min_z_m);
  g.side_m = vec3(sim.max_x_m, sim.max_y_m, sim.max_z_m) - g.min_m;
  g.cell_m = sim.support_radius_m;
  g.cells = ivec3(sim.cells_x, sim.cells_y, sim.cells_z);
  g.candidates_max = int(sim.candidates_max_count);
  return g;
}

/// Returns whether a position is in a cell, which means that all its components are finite. The others are stored after
/// the particles of the last cell, where no search finds them, until diagnostics have counted them and the watchdog
/// acts.
bool hasCell(vec3 position_m) { return isFinite(position_m); }

/// Cell of a position, clamped to the grid. A position without a cell gets the first cell; its sums are not finite
/// anyway.
ivec3 cellOf(Grid g, vec3 position_m) {
  const vec3 c = floor((position_m - g.min_m) / g.cell_m);
  return ivec3(hasCell(position_m) ? clamp(c, vec3(0.0), vec3(g.cells - 1)) : vec3(0.0));
}

int flatCell(Grid g, ivec3 cell) {
  return cell.y + g.cells.y * (cell.x + g.cells.x * cell.z);
}

/// A range of sorted particles, and the shift to add to the own position so that distances are right across a periodic
/// side. Empty when first == last.
struct CandidateRange {
  int first;
  int last;
  vec3 shift_m;
};

/// Moves one axis to a neighbouring column: wraps at a periodic side and sets the shift; returns false outside a wall.
bool neighbourColumn(inout int c, int cells, float side_m, bool periodic, out float shift_m) {
  const bool below = c < 0;
  const bool above = c >= cells;
  shift_m = below ? side_m : (above ? -side_m : 0.0);
  c += below ? cells : (above ? -cells : 0);
  return periodic || !(below || above);
}

/// Returns the cells of the column at (dx, dz) in -1..1 that can hold neighbours as [first, last), not yet as particle
/// indices.
CandidateRange columnCells(Grid g, ivec3 cell, int dx, int dz) {
  CandidateRange r;
  int x = cell.x + dx;
  int z = cell.z + dz;
  r.shift_m = vec3(0.0);
  const bool inside_x = neighbourColumn(x, g.cells.x, g.side_m.x, PERIODIC_X == 1, r.shift_m.x);
  const bool inside_z = neighbourColumn(z, g.cells.z, g.side_m.z, PERIODIC_Z == 1, r.shift_m.z);
  const int base = g.cells.y * (x + g.cells.x * z);
  const bool inside = inside_x && inside_z;
#if PERIODIC_Y
  r.first = inside ? base : 0;
  r.last = inside ? base + g.cells.y : 0;
#else
  r.first = inside ? base + max(cell.y - 1, 0) : 0;
  r.last = inside ? base + min(cell.y + 1, g.cells.y - 1) + 1 : 0;
#endif
  return r;
}

#endif
