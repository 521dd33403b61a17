// The thesis's arrays: particles of 48 bytes that stay where they are, and a grid of 32^3 cells over their box with count,
// start and contents, the indices of the particles ordered by cell (thesis 3.5, 3.6.1).
#ifndef THESIS_PARTICLES
#define THESIS_PARTICLES

#include "shared/sim_uniforms.h"

#define SIDE 32
#define CELLS (SIDE * SIDE * SIDE)

struct Particle {
  vec4 pos;  // [m], w: radius [m]
  vec4 vel;  // [m/s], w: pressure [Pa]
  vec4 acc;  // [m/s^2], w: density [kg/m^3]
};
layout(std430, binding = 0) restrict buffer Particles { Particle particle[]; };
layout(std430, binding = 1) restrict buffer Count { uint count[]; };
layout(std430, binding = 2) restrict buffer Start { uint start[]; };
layout(std430, binding = 3) restrict buffer Contents { uint contents[]; };

struct Cells {
  vec3 min_m;
  vec3 side_m;
  ivec3 n;  ///< along each axis at most SIDE, and fewer where cells would be smaller than H
};

Cells loadCells() {
  Cells c;
  c.min_m = vec3(sim.min_x_m, sim.min_y_m, sim.min_z_m);
  c.side_m = vec3(sim.max_x_m, sim.max_y_m, sim.max_z_m) - c.min_m;
  c.n = clamp(ivec3(c.side_m / sim.support_radius_m + 1e-4), ivec3(1), ivec3(SIDE));
  return c;
}

ivec3 cellOf(Cells c, vec3 x) { return clamp(ivec3(floor((x - c.min_m) / c.side_m * vec3(c.n))), ivec3(0), c.n - 1); }

int flatCell(ivec3 cell) { return cell.x + SIDE * (cell.y + SIDE * cell.z); }

#ifdef PERIODIC_X
/// Moves an axis of a cell to the other side where it is periodic; false outside of a wall.
bool inside(inout int cell, int n, float side_m, bool periodic, out float shift_m) {
  shift_m = cell < 0 ? side_m : (cell >= n ? -side_m : 0.0);
  const bool is_inside = cell >= 0 && cell < n;
  cell += cell < 0 ? n : (cell >= n ? -n : 0);
  return is_inside || periodic;
}

/// Particles of a neighbour cell as a range of `contents`, and what to add to the own position across a periodic side.
bool neighbourCell(Cells c, ivec3 cell, out uint first, out uint last, out vec3 shift_m) {
  const bool in_x = inside(cell.x, c.n.x, c.side_m.x, PERIODIC_X == 1, shift_m.x);
  const bool in_y = inside(cell.y, c.n.y, c.side_m.y, false, shift_m.y);
  const bool in_z = inside(cell.z, c.n.z, c.side_m.z, PERIODIC_Z == 1, shift_m.z);
  if (!(in_x && in_y && in_z)) return false;
  const int flat_cell = flatCell(cell);
  first = start[flat_cell];
  last = flat_cell + 1 < CELLS ? start[flat_cell + 1] : sim.particle_count;
  return true;
}
#endif

#endif
