// Positions to cells and cells to ranges of the sorted particles. Cells have edge H and are numbered y fastest: y is the axis
// that water's own box never has periodic, so the three y-neighbours of a column are one contiguous range everywhere, and the 27
// cells around a particle are nine ranges without a special case at the sides. In a box that is periodic in y, meant to be a few
// cells thick, all of a column are candidates. PERIODIC_X, PERIODIC_Y and PERIODIC_Z are 0 or 1.
#ifndef SPINDRIFT_GRID_HASH
#define SPINDRIFT_GRID_HASH

#include "common/finite.glsl"
#include "shared/grid.h"
#include "shared/sim_uniforms.h"

/// The grid in registers: loops must not touch the uniform block.
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

/// Whether a position is in a cell: all of it is finite. Others are kept behind the particles of the last cell, where no
/// search finds them, until diagnostics have counted them and the watchdog acts.
bool hasCell(vec3 position_m) { return isFinite(position_m); }

/// Cell of a position, clamped to the grid. The first one for a position without a cell, whose sums are not finite
/// whatever it meets.
ivec3 cellOf(Grid g, vec3 position_m) {
  const vec3 c = floor((position_m - g.min_m) / g.cell_m);
  return ivec3(hasCell(position_m) ? clamp(c, vec3(0.0), vec3(g.cells - 1)) : vec3(0.0));
}

int flatCell(Grid g, ivec3 cell) {
  return cell.y + g.cells.y * (cell.x + g.cells.x * cell.z);
}

/// A run of sorted particles, and what to add to one's own position so that distances to them are right across a
/// periodic side. Empty when first == last.
struct CandidateRange {
  int first;
  int last;
  vec3 shift_m;
};

/// One axis of a neighbouring column: wraps on a periodic side and says by how much to shift; false outside of walls.
bool neighbourColumn(inout int c, int cells, float side_m, bool periodic, out float shift_m) {
  const bool below = c < 0;
  const bool above = c >= cells;
  shift_m = below ? side_m : (above ? -side_m : 0.0);
  c += below ? cells : (above ? -cells : 0);
  return periodic || !(below || above);
}

/// Cells of the column at (dx, dz) in -1..1 that can hold neighbours, as [first, last), before the start lookup.
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
