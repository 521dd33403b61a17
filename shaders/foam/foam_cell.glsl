// Cells of the foam field: half as many along each axis as the wave has, rounded up. They span the water exactly, so that with
// an odd number of wave cells a foam cell is a little shorter than two of them.
#ifndef SPINDRIFT_FOAM_CELL
#define SPINDRIFT_FOAM_CELL

#include "common/finite.glsl"

/// Foam cells along x and z of a wave of n cells.
ivec2 foamCounts(ivec2 n) { return (n + 1) / 2; }

/// The foam cell that the corner of a wave cell lies in.
ivec2 foamCellOf(ivec2 wave_cell, ivec2 n) { return wave_cell * foamCounts(n) / n; }

/// The first wave cell of a foam cell; the next one along each axis belongs to it, too, if there is one.
ivec2 firstWaveCellOf(ivec2 foam_cell, ivec2 n) { return foam_cell * n / foamCounts(n); }

int foamIndexOf(ivec2 foam_cell, ivec2 n) { return foam_cell.x + foamCounts(n).x * foam_cell.y; }

/// White water of all sources, 0..1.
float whiteOf(vec4 sources) {
  const float white = sources.x + sources.y + sources.z;
  return isNaN(white) ? 0.0 : clamp(white, 0.0, 1.0);
}

#endif
