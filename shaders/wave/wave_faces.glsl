// The faces of wave cells. Cell (i, k) owns the faces toward (i+1, k) and (i, k+1); with the 9-point stencil also the two
// diagonals of the square that it spans with its neighbours: (i, k) to (i+1, k+1), and (i+1, k) to (i, k+1).
// A face carries flow [m^2/s] and has a conductance: still depth times the stencil's weight, 0 where it is closed.
// The weights make the isotropic Laplacian (4 sides + corners - 20 centre)/6 = 2/3 (5-point) + 1/6 (corners - 4 centre); beside
// closed squares they differ, and come from the table (sim_setup/basin.cpp).
#ifndef SPINDRIFT_WAVE_FACES
#define SPINDRIFT_WAVE_FACES

#include "shared/effects.h"
#include "wave/wave_cell.glsl"

#if STENCIL == 9
#define Flow vec4
#define FLOW_WEIGHTS vec4(2.0 / 3.0, 2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0)
#define asFlow(v) (v)
#else
#define Flow vec2
#define FLOW_WEIGHTS vec2(1.0)
#define asFlow(v) ((v).xy)
#endif

/// What a cell's faces carry. Nonlinear: velocities toward +x and +z [m/s], then the water that they move [m^2/s].
#if NONLINEAR
#define StoredFlow vec4
#else
#define StoredFlow Flow
#endif

#if VARIED
layout(binding = BASIN) uniform samplerBuffer basin;
#endif

/// Conductance of the faces that a cell owns. [m]
Flow conductanceOf(ivec2 cell, ivec2 n) {
#if VARIED
  return asFlow(texelFetch(basin, cell.x + n.x * cell.y));
#else
#if WAVE_PERIODIC_X
  const float open_x = 1.0;
#else
  const float open_x = cell.x < n.x - 1 ? 1.0 : 0.0;
#endif
#if WAVE_PERIODIC_Z
  const float open_z = 1.0;
#else
  const float open_z = cell.y < n.y - 1 ? 1.0 : 0.0;
#endif
  return sim.wave_depth_m * FLOW_WEIGHTS * asFlow(vec4(open_x, open_z, open_x * open_z, open_x * open_z));
#endif
}

#if DISPERSE
/// Share of an effect that passes the faces toward +x and +z of a cell: falls to 0 over EFFECT_TAPER_CELLS before a closed
/// face along the axis. The water that a wall holds back would stand in the cells beside it, and where short waves are
/// slow it would stay there.
vec2 taperOf(ivec2 cell, ivec2 n) {
#if VARIED
  return texelFetch(basin, cell.x + n.x * cell.y).zw;
#else
  vec2 share = vec2(1.0);
#if !WAVE_PERIODIC_X
  share.x = min(float(min(cell.x + 1, n.x - 1 - cell.x)) / float(EFFECT_TAPER_CELLS), 1.0);
#endif
#if !WAVE_PERIODIC_Z
  share.y = min(float(min(cell.y + 1, n.y - 1 - cell.y)) / float(EFFECT_TAPER_CELLS), 1.0);
#endif
  return share;
#endif
}
#endif

#endif
