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

// Most candidates are farther than H. A pass with NOTE_NEAR, which visits all, notes the others: the first candidate of each of the nine
// columns, and bits of those that follow it. A pass with VISIT_NEAR over the same positions visits only these. What it leaves out adds
// zero to every sum, so sums stay the same bit for bit. A particle with a column of more than NEAR_BITS candidates notes none and visits
// all.
#define NEAR_BITS 32
#define NONE_NOTED 0xffffffffu
// Squared distance over H^2 from which a candidate is left out: rounding differs between passes.
#define NEAR_REACH 1.0001

#if defined(NOTE_NEAR)
layout(std430, binding = NEAR_CANDIDATES) restrict writeonly buffer NearCandidates { uvec2 near_candidates[]; };
bool is_long = false;

struct NearBits {
  uint noted;
  uint next;
};

NearBits noneNear() { return NearBits(0u, 1u); }

/// Call it for each candidate of a range, in order.
void noteNear(inout NearBits near, float r2, Grid g) {
  near.noted |= r2 < NEAR_REACH * g.cell_m * g.cell_m ? near.next : 0u;
  near.next += near.next;
}

/// Call it after each range of a particle.
void storeNear(uint i, int dx, int dz, CandidateRange range, NearBits near) {
  near_candidates[9u * i + uint(3 * dz + dx + 4)] = uvec2(range.first, near.noted);
  is_long = is_long || range.last - range.first > NEAR_BITS;
}

/// Call it after the last range of a particle. A loop that no lane needs costs llvmpipe less than a branch.
void endNear(uint i) {
  for (uint k = is_long ? 0u : 9u; k < 9u; ++k) near_candidates[9u * i + k] = uvec2(NONE_NOTED, 0u);
}
#elif defined(VISIT_NEAR)
layout(binding = NEAR_CANDIDATES) uniform usamplerBuffer near_candidates;

/// One loop over the candidates of all columns, because llvmpipe takes as long to enter a loop as for several candidates.
struct Near {
  int at;
  int end;
  int dx;
  int dz;
  uint bits;  ///< of this column, still to visit
  int first;
  vec3 shift_m;
  int j;  ///< the candidate; none if negative
};

Near beforeNear(uint i) { return Near(9 * int(i), 9 * int(i) + 9, -2, -1, 0u, 0, vec3(0.0), -1); }

/// Moves to the next candidate, or to the next column; false after the last.
bool nextNear(inout Near n, Grid g, ivec3 cell) {
  if (n.bits == 0u) {
    if (n.at == n.end) return false;
    const uvec2 word = texelFetch(near_candidates, n.at++).xy;
    n.first = int(word.x);
    n.bits = word.y;
    n.dz += n.dx == 1 ? 1 : 0;
    n.dx = n.dx == 1 ? -1 : n.dx + 1;
#if PERIODIC_X
    int x = cell.x + n.dx;
    neighbourColumn(x, g.cells.x, g.side_m.x, true, n.shift_m.x);
#endif
#if PERIODIC_Z
    int z = cell.z + n.dz;
    neighbourColumn(z, g.cells.z, g.side_m.z, true, n.shift_m.z);
#endif
  }
  // The number of the lowest bit is the exponent of its float: llvmpipe's findLSB takes four times as long.
  const int lowest = ((floatBitsToInt(float(int(n.bits & (0u - n.bits)))) >> 23) & 255) - 127;
  n.j = n.bits != 0u ? n.first + lowest : -1;
  n.bits &= n.bits - 1u;
  return true;
}

/// First value of dz in a loop over all candidates: 2, and so no loop, where the others are noted.
int firstRow(uint i) { return texelFetch(near_candidates, 9 * int(i)).x == NONE_NOTED ? -1 : 2; }
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
