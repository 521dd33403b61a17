// One leapfrog step of the damped wave equation (thesis 3.21, 3.6.3).
// Reads ELEVATION, ELEVATION_PREVIOUS [n x n, m]. Writes ELEVATION_NEXT.
// Equation: eta_tt + kappa eta_t = c^2 laplacian(eta), central in time; the damping sits on the velocity term alone:
//   eta+ = eta + keep (eta - eta-) + gain S^2 L(eta),  keep = (1 - kappa dt/2)/(1 + kappa dt/2), gain = 1/(1 + kappa dt/2)
// L is the 5-point Laplacian, or the isotropic 9-point one (4 sides + corners - 20 centre)/6.
// Invariant: a constant elevation is a fixed point to the last bit.
// variants: STENCIL=5 WAVE_PERIODIC=1 | STENCIL=9 WAVE_PERIODIC=0
#include "shared/groups.h"
#include "include/wave_cell.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = ELEVATION) uniform samplerBuffer elevation;
layout(binding = ELEVATION_PREVIOUS) uniform samplerBuffer elevation_previous;
layout(std430, binding = ELEVATION_NEXT) restrict writeonly buffer ElevationNext { float elevation_next[]; };

float at(int x, int row) { return texelFetch(elevation, x + row).x; }

void main() {
  const int n = int(sim.wave_n);
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (cell.x >= n || cell.y >= n) return;
  const int left = waveNeighbour(cell.x - 1, n);
  const int right = waveNeighbour(cell.x + 1, n);
  const int row = n * cell.y;
  const int before = n * waveNeighbour(cell.y - 1, n);
  const int after = n * waveNeighbour(cell.y + 1, n);

  const float eta = at(cell.x, row);
  const float sides = (at(left, row) - eta) + (at(right, row) - eta) + (at(cell.x, before) - eta) + (at(cell.x, after) - eta);
#if STENCIL == 9
  const float corners = (at(left, before) - eta) + (at(right, before) - eta) + (at(left, after) - eta) + (at(right, after) - eta);
  const float laplacian = (4.0 * sides + corners) / 6.0;
#else
  const float laplacian = sides;
#endif
  const float change = eta - texelFetch(elevation_previous, cell.x + row).x;
  elevation_next[cell.x + row] = eta + sim.wave_keep * change + sim.wave_gain * sim.courant2 * laplacian;
}
