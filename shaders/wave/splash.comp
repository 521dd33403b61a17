// Splashes displace water: invocations (x, y) cover the square that a splash can reach, z is the index of the splash.
// Each adds to the two faces that its cell owns.
// Reads EventUniforms, BASIN, BED, ELEVATION. Adds to TRANSFER [n x n, units]; raises LIMIT_ARGS as wave/momentum.comp
// does.
// Invariant: a face's transfer is computed by one invocation per splash; nothing passes a closed face.
#include "shared/groups.h"
#include "wave/displacement.glsl"
#include "common/event_shapes.glsl"

layout(local_size_x = PATCH_GROUP, local_size_y = PATCH_GROUP) in;

void main() {
  const EventUniform e = splashes[gl_GlobalInvocationID.z];
  const int n = int(sim.wave_n);
  const float cell_m = sim.wave_cell_m;
  // Number of cells of the square: as many as the splash needs; along a periodic axis at most the whole domain once.
  ivec2 across = ivec2(min(2 * int(ceil(SPLASH_REACH * e.radius_m / cell_m)) + 4, 2 * n));
#if WAVE_PERIODIC_X
  across.x = min(across.x, n);
#endif
#if WAVE_PERIODIC_Z
  across.y = min(across.y, n);
#endif
  if (any(greaterThanEqual(ivec2(gl_GlobalInvocationID.xy), across))) return;
  ivec2 cell = ivec2(floor((vec2(e.x_m, e.z_m) + 0.5 * sim.wave_side_m) / cell_m)) - across / 2 + ivec2(gl_GlobalInvocationID.xy);
#if WAVE_PERIODIC_X
  cell.x = wrapped(cell.x, n);
#endif
#if WAVE_PERIODIC_Z
  cell.y = wrapped(cell.y, n);
#endif
  if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, ivec2(n)))) return;
  const float units = e.gain_m * ELEVATION_UNITS_PER_M / cell_m;
  const vec2 p = waveCellCentre(cell);
  const vec2 centre = vec2(e.x_m, e.z_m);
  const vec2 at_x = acrossSides(p + vec2(0.5 * cell_m, 0.0) - centre);
  const vec2 at_z = acrossSides(p + vec2(0.0, 0.5 * cell_m) - centre);
  const Flow open = conductanceOf(cell, n);
  const int i = cell.x + n * cell.y;
  if (open.x > 0.0)
    addTransfer(i, wrapped(cell.x + 1, n) + n * cell.y, 0u, transferUnits(-splashDisplacement(at_x, e.radius_m).x, units));
  if (open.y > 0.0)
    addTransfer(i, cell.x + n * wrapped(cell.y + 1, n), 1u, transferUnits(-splashDisplacement(at_z, e.radius_m).y, units));
}
