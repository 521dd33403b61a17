// The water over the bed of a wave cell, elevation + still depth, in units. No pass of the wave takes more than that
// from a cell, so it is never negative.
#ifndef SPINDRIFT_WATER_COLUMN
#define SPINDRIFT_WATER_COLUMN

#include "wave/wave_faces.glsl"
#include "shared/fixed_point.h"

#if VARIED
layout(binding = BED) uniform samplerBuffer bed;
#endif

#if STENCIL == 9
#define Units ivec4
#define FACES_PER_CELL 8u
#else
#define Units ivec2
#define FACES_PER_CELL 4u
#endif
#define OWNED_FACES (FACES_PER_CELL / 2u)

/// Still depth at the centre of a cell; 0 on dry ground, negative there with a nonlinear bulk. [m]
float stillDepth(int i) {
#if VARIED
  return texelFetch(bed, i).z;
#else
  return sim.wave_depth_m;
#endif
}

/// Elevation above the bed. Depths reach 100 m and elevations 128 m: their sum needs all 32 bits.
uint heldUnits(int elevation_units, float depth_m) {
  const int bed_units = -int(depth_m * ELEVATION_UNITS_PER_M);
  return elevation_units > bed_units ? uint(elevation_units) - uint(bed_units) : 0u;
}

float metresOf(uint units) { return float(units) * ELEVATION_UNIT_M; }

/// Returns whether a transfer could exceed the water of the giving cell if all its faces carried as much.
bool mayEmpty(int transfer_units, uint held_here, uint held_there) {
  return uint(abs(transfer_units)) > (transfer_units > 0 ? held_here : held_there) / FACES_PER_CELL;
}

/// Groups of the passes that limit transfers, for LIMIT_ARGS.
uint limitGroups() { return (sim.wave_nx + uint(WAVE_GROUP_X) - 1u) / uint(WAVE_GROUP_X); }

#endif
