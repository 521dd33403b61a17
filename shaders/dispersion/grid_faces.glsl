// The faces of one grid of the dispersion's V-cycle (sim_setup/dispersion.h). A texel holds the x face and the z face of a
// cell, two poles each: (x_0, x_1, z_0, z_1) [m * elevation units]. Closed faces hold 0, so that indices may wrap around
// every side.
//   K phi = m phi - grad(e div phi), with differences between cells as grad and div
// FINEST: 1 for the grid of the wave, whose right side is the slope of the surface.
#ifndef SPINDRIFT_DISPERSION_GRID_FACES
#define SPINDRIFT_DISPERSION_GRID_FACES

#include "shared/bindings.h"
#include "wave/wave_cell.glsl"

// m_x, m_z, e_0, e_1 [1/m].
layout(binding = DISPERSION_STIFFNESS) uniform samplerBuffer stiffness;
// Weight of a sweep over the diagonal of K [m].
layout(binding = DISPERSION_SWEEP) uniform samplerBuffer sweep_weight;

#if FINEST
layout(binding = ELEVATION) uniform isamplerBuffer elevation;
#if HEAD
layout(binding = PRESSURE_HEAD) uniform isamplerBuffer pressure_head;
#endif
layout(binding = DISPERSION_ROOT_C) uniform samplerBuffer root_c;
#else
layout(binding = DISPERSION_RIGHT) uniform samplerBuffer right_side;
#endif

/// Cells per side of this grid.
int gridSide() {
#if FINEST
  return int(sim.wave_n);
#else
  return int(sqrt(float(textureSize(right_side))) + 0.5);
#endif
}

int cellAt(ivec2 cell, int n) { return wrapped(cell.x, n) + n * wrapped(cell.y, n); }

#if FINEST
int levelAt(int i) {
#if HEAD
  return texelFetch(elevation, i).x + texelFetch(pressure_head, i).x;
#else
  return texelFetch(elevation, i).x;
#endif
}

/// Slope of the surface at the two faces of a cell, for each pole. [elevation units per cell]
vec4 slopeAt(ivec2 cell, int n) {
  const int here = levelAt(cellAt(cell, n));
  const vec2 slope = vec2(levelAt(cellAt(cell + ivec2(1, 0), n)) - here, levelAt(cellAt(cell + ivec2(0, 1), n)) - here);
  return slope.xxyy;
}
#endif

vec4 rightSideAt(ivec2 cell, int n) {
#if FINEST
  return texelFetch(root_c, cellAt(cell, n)) * slopeAt(cell, n);
#else
  return texelFetch(right_side, cellAt(cell, n));
#endif
}

/// e div phi of a cell, from the faces around it.
vec2 pressed(vec4 own, vec4 left, vec4 before, vec4 at) { return at.zw * (own.xy - left.xy + own.zw - before.zw); }

#endif
