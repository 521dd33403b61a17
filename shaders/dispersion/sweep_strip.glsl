// A damped Jacobi sweep on one grid: phi + w (r - K phi). An invocation sweeps a strip of cells along z and keeps what the
// next cell needs again: 7 texels per cell instead of 12.
// The shader that includes this file defines faceAt() and put().
#ifndef SPINDRIFT_DISPERSION_SWEEP_STRIP
#define SPINDRIFT_DISPERSION_SWEEP_STRIP

#include "dispersion/grid_faces.glsl"
#include "shared/groups.h"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

/// The faces of a cell before the sweep; x and z inside the grid.
vec4 faceAt(int x, int z, int n);
/// Stores the faces of cell i after the sweep.
void put(int i, vec4 phi);

void sweepStrip() {
  const int n = gridSide();
  const int x = int(gl_GlobalInvocationID.x);
  const int first = int(gl_GlobalInvocationID.y) * DISPERSION_STRIP;
  if (x >= n || first >= n) return;
  const int end = min(first + DISPERSION_STRIP, n);
  const int left = wrapped(x - 1, n);
  const int right = wrapped(x + 1, n);
  const int before = wrapped(first - 1, n);
  vec4 own = faceAt(x, first, n);
  vec4 east = faceAt(right, first, n);
  vec4 stiff = texelFetch(stiffness, x + n * first);
  vec2 here = pressed(own, faceAt(left, first, n), faceAt(x, before, n), stiff);
  vec2 there = pressed(east, own, faceAt(right, before, n), texelFetch(stiffness, right + n * first));
#if FINEST
  int level = levelAt(x + n * first);
  int level_east = levelAt(right + n * first);
#endif
  for (int z = first; z < end; ++z) {
    const int i = x + n * z;
    const int next = wrapped(z + 1, n);
    const int row = n * next;
    const vec4 own_next = faceAt(x, next, n);
    const vec4 east_next = faceAt(right, next, n);
    const vec4 stiff_next = texelFetch(stiffness, x + row);
    const vec2 here_next = pressed(own_next, faceAt(left, next, n), own, stiff_next);
    const vec2 there_next = pressed(east_next, own_next, east, texelFetch(stiffness, right + row));
#if FINEST
    const int level_next = levelAt(x + row);
    const int level_east_next = levelAt(right + row);
    const vec4 r = texelFetch(root_c, i) * vec2(level_east - level, level_next - level).xxyy;
    level = level_next;
    level_east = level_east_next;
#else
    const vec4 r = texelFetch(right_side, i);
#endif
    put(i, own + texelFetch(sweep_weight, i) * (r - stiff.xxyy * own + vec4(there - here, here_next - here)));
    own = own_next;
    east = east_next;
    stiff = stiff_next;
    here = here_next;
    there = there_next;
  }
}

#endif
