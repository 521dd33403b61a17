// Splashes displace water. Each invocation adds to the two faces that its cell owns. Few or small splashes: (x, y) is the
// cell in the square that a splash can reach, z the index of the splash. Many or large ones (every_cell): (x, y) is the
// cell of the domain, and the invocation sums all splashes before it adds, because reading the water column and the
// atomic addition cost more than the splash itself.
// Reads EventUniforms, BASIN, BED, ELEVATION. Adds to TRANSFER [nx x nz, units]; raises LIMIT_ARGS as wave/momentum.comp
// does.
// Invariant: both ways add the same integers; nothing passes a closed face.
#include "shared/groups.h"
#include "wave/displacement.glsl"
#include "common/event_shapes.glsl"

layout(local_size_x = PATCH_GROUP, local_size_y = PATCH_GROUP) in;

/// Turns a position in the square of a splash into its cell. Returns false outside the square and outside the domain.
bool findCell(EventUniform e, ivec2 n, inout ivec2 cell) {
  const float cell_m = sim.wave_cell_m;
  // Number of cells of the square: as many as the splash needs; along a periodic axis at most the whole domain once.
  ivec2 across = ivec2(2 * int(ceil(SPLASH_REACH * e.radius_m / cell_m)) + 4);
#if WAVE_PERIODIC_X
  across.x = min(across.x, n.x);
#endif
#if WAVE_PERIODIC_Z
  across.y = min(across.y, n.y);
#endif
  if (any(greaterThanEqual(cell, across))) return false;
  cell += ivec2(floor((vec2(e.x_m, e.z_m) + waveHalf_m()) / cell_m)) - across / 2;
#if WAVE_PERIODIC_X
  cell.x = wrapped(cell.x, n.x);
#endif
#if WAVE_PERIODIC_Z
  cell.y = wrapped(cell.y, n.y);
#endif
  return all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, n));
}

/// Index of the first splash in [low, high) that is not below a z; these are in the order of z.
uint firstFrom(float z_m, uint low, uint high) {
  while (low < high) {
    const uint middle = (low + high) / 2u;
    if (splashes[middle].z_m < z_m) low = middle + 1u;
    else high = middle;
  }
  return low;
}

/// The splashes in [low, high) that can reach a row.
uvec2 nearRow(float z_m, uint low, uint high) {
#if WAVE_PERIODIC_Z
  return uvec2(low, high);
#else
  const float reach = reach_m + sim.wave_cell_m;
  return uvec2(firstFrom(z_m - reach, low, high), firstFrom(z_m + reach, low, high));
#endif
}

void main() {
  const ivec2 n = waveCounts();
  const float cell_m = sim.wave_cell_m;
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  const uint own = gl_GlobalInvocationID.z;
  if (every_cell == 0u) {
    if (!findCell(splashes[own], n, cell)) return;
  } else if (any(greaterThanEqual(cell, n))) {
    return;
  }
  const vec2 p = waveCellCentre(cell);
  const uvec2 near = every_cell == 0u ? uvec2(own, own + 1u) : nearRow(p.y, 0u, press_begin);
  const uvec2 near_presses = every_cell == 0u ? uvec2(0u) : nearRow(p.y, press_begin, splash_count);
  const uint near_count = near.y - near.x;
  const int i = cell.x + n.x * cell.y;
  const ivec2 next = nextCells(cell, n);
  const vec4 shares = effectShares(cell, next, n);
  const vec3 away_m = abs(vec3(metres(texelFetch(elevation, i).x), metres(texelFetch(elevation, next.x).x),
                               metres(texelFetch(elevation, next.y).x)));
  ivec2 moved = ivec2(0);
  for (uint k = 0u; k < near_count + near_presses.y - near_presses.x; ++k) {
    const EventUniform e = splashes[k < near_count ? near.x + k : near_presses.x + k - near_count];
    const float units = e.gain_m * ELEVATION_UNITS_PER_M / cell_m;
    const vec2 centre = vec2(e.x_m, e.z_m);
    const float reach = SPLASH_REACH * e.radius_m + cell_m;
    // A loop, because a software rasteriser computes both ways of a condition.
    for (bool is_near = abs(acrossSides(p - centre).x) < reach; is_near; is_near = false) {
      const vec2 at_x = acrossSides(p + vec2(0.5 * cell_m, 0.0) - centre);
      const vec2 at_z = acrossSides(p + vec2(0.0, 0.5 * cell_m) - centre);
      vec2 displaced_m2 =
          passing(-vec2(splashDisplacement(at_x, e.radius_m).x, splashDisplacement(at_z, e.radius_m).y), shares);
      if (e.highest_m > 0.0) displaced_m2 *= strokeShares(away_m, e.highest_m);
      moved += ivec2(transferUnits(displaced_m2.x, units), transferUnits(displaced_m2.y, units));
    }
  }
  if (moved == ivec2(0)) return;
  const Flow open = conductanceOf(cell, n);
  if (open.x > 0.0) addTransfer(i, next.x, 0u, moved.x);
  if (open.y > 0.0) addTransfer(i, next.y, 1u, moved.y);
}
