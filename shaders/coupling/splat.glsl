// Spreads an integer amount over the (4m+1) x (4m+1) wave cells around one, m = splat_reach_count. The weights are four
// boxes of m+1 cells convolved (m = 1: 1 4 6 4 1 over 16), about as wide as the droplet; narrower weights would excite
// single cells until they break. The remainder from rounding and dry cells goes to the middle, so that the whole amount
// arrives. Integer additions, so the order does not matter.
#ifndef SPINDRIFT_SPLAT
#define SPINDRIFT_SPLAT

#include "wave/wave_cell.glsl"

// Water may stand on any ground of a nonlinear bulk; elsewhere some cells never hold water.
#if VARIED && !NONLINEAR
#define HAS_DRY_CELLS 1
#include "common/terrain_texels.glsl"
layout(binding = LANDING) uniform isamplerBuffer landing;
#else
#define HAS_DRY_CELLS 0
#endif

/// The cell at a position; if it is dry, the wet cell that its water runs to.
ivec2 wetCellAt(vec2 xz, ivec2 n) {
  const vec2 u = floor((xz + waveHalf_m()) / sim.wave_cell_m);
  const ivec2 cell = ivec2(waveNeighbourX(int(u.x), n.x), waveNeighbourZ(int(u.y), n.y));
#if HAS_DRY_CELLS
  const int at = texelFetch(landing, cell.x + n.x * cell.y).x;
  return ivec2(at % n.x, at / n.x);
#else
  return cell;
#endif
}

/// Index of the cell at an offset from a wet one that receives its share; -1 if the middle receives it.
int splatTarget(ivec2 middle, ivec2 offset, ivec2 n) {
  ivec2 cell = middle + offset;
  // The splat may be wider than narrow water, by up to 16 cells (kMaxSplatReach); % of negative numbers is undefined.
#if WAVE_PERIODIC_X
  cell.x = (cell.x + 16 * n.x) % n.x;
#endif
#if WAVE_PERIODIC_Z
  cell.y = (cell.y + 16 * n.y) % n.y;
#endif
  if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, n))) return -1;
  const int i = cell.x + n.x * cell.y;
#if HAS_DRY_CELLS
  if (texelFetch(terrain, i).w <= 0.0) return -1;
#endif
  return i;
}

/// Binomial coefficient: number of ways to choose three of `x`.
int chooseThree(int x) {
  return x < 3 ? 0 : x * (x - 1) * (x - 2) / 6;
}

/// Share of the whole on one axis, `offset` cells from the middle. Shares sum to 1.
float splatWeight(int offset, int reach) {
  const int k = 2 * reach - abs(offset);
  const float boxes = float(reach + 1);
  return float(chooseThree(k + 3) - 4 * chooseThree(k + 2 - reach)) / (boxes * boxes * boxes * boxes);
}

/// amount times the share of the cell at `offset`, rounded toward zero.
int splatShare(int amount, ivec2 offset, int reach) {
  return int(float(amount) * splatWeight(offset.x, reach) * splatWeight(offset.y, reach));
}

#endif
