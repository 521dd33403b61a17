// Neighbour search of the density and force passes: ranges of sorted particles around a cell. The length of a range is
// limited, so that all particles in one cell cost a multiple of their number and not its square. Candidates beyond the
// limit are skipped; passes that define COUNT_CROWDED count the affected particles in CROWDED.
#ifndef SPINDRIFT_CANDIDATES
#define SPINDRIFT_CANDIDATES

#include "grid/grid_hash.glsl"

layout(binding = CELL_START) uniform usamplerBuffer cell_start;

#if defined(COUNT_CROWDED) || defined(COUNT_CANDIDATES)
/// [0]: number of particles with skipped candidates since the buffer was made. [1]: number of candidates visited, only
/// with COUNT_CANDIDATES (tests).
layout(std430, binding = CROWDED) restrict buffer Crowded { uint crowded[]; };
#endif
bool is_crowded = false;

CandidateRange candidateRange(Grid g, ivec3 cell, int dx, int dz) {
  CandidateRange r = columnCells(g, cell, dx, dz);
  r.first = int(texelFetch(cell_start, r.first).x);
  r.last = int(texelFetch(cell_start, r.last).x);
  is_crowded = is_crowded || r.last - r.first > g.candidates_max;
  r.last = min(r.last, r.first + g.candidates_max);
#ifdef COUNT_CANDIDATES
  atomicAdd(crowded[1], uint(r.last - r.first));
#endif
  return r;
}

#ifdef COUNT_CROWDED
/// Call it after the last range of a particle.
void countCrowded() {
  if (is_crowded) atomicAdd(crowded[0], 1u);
}
#endif

/// Vector from a candidate at x_j to the particle at x, with the shift of the range; the shorter way if y is periodic.
vec3 fromCandidate(Grid g, vec3 x, vec3 x_j) {
  vec3 r = x - x_j;
#if PERIODIC_Y
  r.y -= g.side_m.y * round(r.y / g.side_m.y);
#endif
  return r;
}

#endif
