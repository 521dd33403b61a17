// Spreads an integer amount over the 5 x 5 wave cells around one, with binomial weights (1 4 6 4 1)^2 / 256; what rounding and dry
// cells leave goes to the middle, so that the whole amount arrives. Integer additions: the order does not matter.
#ifndef SPINDRIFT_SPLAT
#define SPINDRIFT_SPLAT

#include "include/wave_cell.glsl"

#if VARIED
#include "include/terrain_texels.glsl"
layout(binding = LANDING) uniform isamplerBuffer landing;
#endif

const int kBinomial[5] = int[5](1, 4, 6, 4, 1);

/// The cell under a place; where that is dry, the wet cell that its water runs to.
ivec2 wetCellAt(vec2 xz, int n) {
  const vec2 u = floor((xz + 0.5 * sim.wave_side_m) / sim.wave_cell_m);
  const ivec2 cell = ivec2(waveNeighbourX(int(u.x), n), waveNeighbourZ(int(u.y), n));
#if VARIED
  const int at = texelFetch(landing, cell.x + n * cell.y).x;
  return ivec2(at % n, at / n);
#else
  return cell;
#endif
}

/// Index of the cell at an offset from a wet one that takes its share; -1 where the middle takes it.
int splatTarget(ivec2 middle, ivec2 offset, int n) {
  ivec2 cell = middle + offset;
#if WAVE_PERIODIC_X
  cell.x = wrapped(cell.x, n);
#endif
#if WAVE_PERIODIC_Z
  cell.y = wrapped(cell.y, n);
#endif
  if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, ivec2(n)))) return -1;
  const int i = cell.x + n * cell.y;
#if VARIED
  if (texelFetch(terrain, i).w <= 0.0) return -1;
#endif
  return i;
}

/// amount * weight / 256, toward zero.
int splatShare(int amount, ivec2 offset) {
  return amount / 256 * (kBinomial[offset.x + 2] * kBinomial[offset.y + 2]);
}

#endif
