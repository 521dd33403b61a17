// The tiles of the water that a floater can reach in a tick.
#ifndef SPINDRIFT_FLOATER_TILES
#define SPINDRIFT_FLOATER_TILES

#include "shared/floaters.h"
#include "wave/wave_cell.glsl"

/// First and last tile along x, and along z. They may lie beyond the sides: tileAt() wraps or clamps them. `place`: centre, reach.
ivec4 tileSpan(vec4 place) {
  const vec2 per_m = float(FLOATER_TILES_PER_AXIS) / (2.0 * waveHalf_m());
  const vec2 low = (place.xz - place.w + waveHalf_m()) * per_m;
  const vec2 high = (place.xz + place.w + waveHalf_m()) * per_m;
  const float n = float(FLOATER_TILES_PER_AXIS);
  // Clamped, because a non-finite position becomes an index.
  ivec2 first = ivec2(floor(clamp(low, vec2(-n), vec2(2.0 * n - 1.0))));
#if !WAVE_PERIODIC_X
  first.x = max(first.x, 0);
#endif
#if !WAVE_PERIODIC_Z
  first.y = max(first.y, 0);
#endif
  const ivec2 last = min(ivec2(floor(clamp(high, vec2(-n), vec2(2.0 * n - 1.0)))), first + FLOATER_TILES_PER_AXIS - 1);
  return ivec4(first.x, last.x, first.y, last.y);
}

/// First word of a tile, of `words` each.
uint tileAt(int x, int z, uint words) {
  return words * uint(waveNeighbourX(x, FLOATER_TILES_PER_AXIS) + FLOATER_TILES_PER_AXIS * waveNeighbourZ(z, FLOATER_TILES_PER_AXIS));
}

#endif
