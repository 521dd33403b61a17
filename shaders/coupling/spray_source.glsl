// Determines which cells hold enough water to emit particles: no cell may give more than it holds, however many cells
// emit at once. All particles of a tick together take at most sim.spray_taken_m from a cell (sim_setup/particle_layout.h). The emitting
// cell also gives the water that other cells in its splat lack.
#ifndef SPINDRIFT_SPRAY_SOURCE
#define SPINDRIFT_SPRAY_SOURCE

#include "coupling/splat.glsl"
#include "wave/surface_rate.glsl"
#include "wave/water_column.glsl"

/// Water over the bed when the surface was sampled, before any emission, minus the rounding error of its floats. [m]
float heldBeforeSpray(int i) {
  const float eta_m = texelFetch(surface_texels, i).x;
  const float depth_m = stillDepth(i);
  return depth_m + eta_m - 2.4e-7 * (depth_m + abs(eta_m));
}

bool givesSpray(int i) { return heldBeforeSpray(i) > sim.spray_taken_m; }

/// Units that the cell at `offset` gives to a particle emitted at `middle`, and the cell's index; 0 if the cell is dry
/// or has too little.
int sprayFrom(ivec2 middle, ivec2 offset, ivec2 n, out int at) {
  at = splatTarget(middle, offset, n);
  return at >= 0 && givesSpray(at) ? splatShare(int(sim.droplet_units), offset, int(sim.splat_reach_count)) : 0;
}

/// Returns whether a cell can emit a particle: it holds its own part plus the parts that other cells lack.
bool canEmit(ivec2 cell, ivec2 n) {
  int rest = int(sim.droplet_units);
  const int reach = int(sim.splat_reach_count);
  for (int dz = -2 * reach; dz <= 2 * reach; ++dz) {
    for (int dx = -2 * reach; dx <= 2 * reach; ++dx) {
      int at;
      rest -= sprayFrom(cell, ivec2(dx, dz), n, at);
    }
  }
  return heldBeforeSpray(cell.x + n.x * cell.y) > sim.spray_taken_m + float(rest) * ELEVATION_UNIT_M;
}

#endif
