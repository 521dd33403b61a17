// Rate of rise of the surface, for the breaking criterion.
#ifndef SPINDRIFT_SURFACE_RATE
#define SPINDRIFT_SURFACE_RATE

#include "wave/wave_cell.glsl"

layout(binding = SURFACE) uniform samplerBuffer surface_texels;

/// Distance of the positions of smoothRate(): one cell, or as far as droplets are spread. A front is wider than that, the ripples
/// of single droplets are not.
ivec2 rateApart(ivec2 n) { return min(ivec2(max(int(sim.splat_width_m / sim.wave_cell_m + 0.5), 1)), n); }

/// Its sum over the positions of one row.
float rowRate(int x, int z, int apart, ivec2 n) {
  const int row = n.x * waveNeighbourZ(z, n.y);
  return texelFetch(surface_texels, waveNeighbourX(x - apart, n.x) + row).y + 2.0 * texelFetch(surface_texels, x + row).y +
         texelFetch(surface_texels, waveNeighbourX(x + apart, n.x) + row).y;
}

/// d eta/dt as a mean over 3 x 3 positions with weights (1 2 1)^2 / 16, from the sums of their rows.
float smoothRate(float before, float own, float after) { return (before + 2.0 * own + after) / 16.0; }

float smoothRate(ivec2 cell, ivec2 n) {
  const ivec2 apart = rateApart(n);
  return smoothRate(rowRate(cell.x, cell.y - apart.y, apart.x, n), rowRate(cell.x, cell.y, apart.x, n), rowRate(cell.x, cell.y + apart.y, apart.x, n));
}

#endif
