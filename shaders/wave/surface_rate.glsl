// Rate of rise of the surface, for the breaking criterion.
#ifndef SPINDRIFT_SURFACE_RATE
#define SPINDRIFT_SURFACE_RATE

#include "wave/wave_cell.glsl"

layout(binding = SURFACE) uniform samplerBuffer surface_texels;

/// d eta/dt as a mean over 3 x 3 positions with weights (1 2 1)^2 / 16. The positions are one cell apart, or as far as
/// droplets are spread: a front is wider than that, the ripples of single droplets are not.
float smoothRate(ivec2 cell, ivec2 n) {
  const ivec2 apart = min(ivec2(max(int(sim.splat_width_m / sim.wave_cell_m + 0.5), 1)), n);
  float sum = 0.0;
  for (int dz = -apart.y; dz <= apart.y; dz += apart.y) {
    const int row = n.x * waveNeighbourZ(cell.y + dz, n.y);
    const float side = dz == 0 ? 2.0 : 1.0;
    sum += side * (texelFetch(surface_texels, waveNeighbourX(cell.x - apart.x, n.x) + row).y + 2.0 * texelFetch(surface_texels, cell.x + row).y +
                   texelFetch(surface_texels, waveNeighbourX(cell.x + apart.x, n.x) + row).y);
  }
  return sum / 16.0;
}

#endif
