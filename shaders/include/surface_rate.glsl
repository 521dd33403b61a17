// How fast the surface rises, as breaking judges it.
#ifndef SPINDRIFT_SURFACE_RATE
#define SPINDRIFT_SURFACE_RATE

#include "include/wave_cell.glsl"

layout(binding = SURFACE) uniform samplerBuffer surface_texels;

/// d eta/dt over 3 x 3 cells with weights (1 2 1)^2 / 16: a front is wider than a cell, the ripples of single drops are not.
float smoothRate(ivec2 cell, int n) {
  float sum = 0.0;
  for (int dz = -1; dz <= 1; ++dz) {
    const int row = n * waveNeighbourZ(cell.y + dz, n);
    const float side = dz == 0 ? 2.0 : 1.0;
    sum += side * (texelFetch(surface_texels, waveNeighbourX(cell.x - 1, n) + row).y + 2.0 * texelFetch(surface_texels, cell.x + row).y +
                   texelFetch(surface_texels, waveNeighbourX(cell.x + 1, n) + row).y);
  }
  return sum / 16.0;
}

#endif
