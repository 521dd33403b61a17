// The neighbour search of density and force passes: ranges of sorted particles around a cell.
#ifndef SPINDRIFT_CANDIDATES
#define SPINDRIFT_CANDIDATES

#include "include/grid_hash.glsl"

layout(binding = CELL_START) uniform usamplerBuffer cell_start;

CandidateRange candidateRange(Grid g, ivec3 cell, int dx, int dz) {
  CandidateRange r = columnCells(g, cell, dx, dz);
  r.first = int(texelFetch(cell_start, r.first).x);
  r.last = int(texelFetch(cell_start, r.last).x);
  return r;
}

/// From a candidate at x_j to the particle at x, its range's shift added; the shorter way round where y is periodic.
vec3 fromCandidate(Grid g, vec3 x, vec3 x_j) {
  vec3 r = x - x_j;
#if PERIODIC_Y
  r.y -= g.side_m.y * round(r.y / g.side_m.y);
#endif
  return r;
}

#endif
