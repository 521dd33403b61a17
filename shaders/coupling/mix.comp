// Water that particles brought back in this tick mixes with the columns that it fell into: its velocity becomes part of theirs.
// Reads ELEVATION [nx x nz, units] (the water is in it), BED, LANDED_WATER. Changes FLOW [nx x nz, velocities at the faces
// toward +x and +z, m/s].
// Equation: u' = (h u + m) / (h + dh), h + dh the water at a face now, dh and m what fell on it and its momentum; means of both
// cells. The mean is between u and the velocity of what fell, so it adds no energy.
#include "shared/groups.h"
#include "coupling/landed_water.glsl"
#include "wave/shallow_column.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(std430, binding = FLOW) restrict buffer Flows { vec4 flow[]; };

float waterOf(int i) { return columnOf(i, texelFetch(elevation, i).x).water_m; }

/// Velocity at the face between two cells. `axis`: 0 along x, 1 along z.
float mixed(float u_mps, int here, int there, int axis) {
  const int landed_units = landed_water[LANDED_WORDS * here] + landed_water[LANDED_WORDS * there];
  if (landed_units <= 0) return u_mps;
  const float momentum = float(landed_water[LANDED_WORDS * here + 1 + axis] + landed_water[LANDED_WORDS * there + 1 + axis]) / MOMENTUM_UNITS;
  const float landed_m = float(landed_units) * ELEVATION_UNIT_M;
  const float water_m = max(waterOf(here) + waterOf(there), landed_m);
  return u_mps + (momentum - landed_m * u_mps) / water_m;
}

void main() {
  const ivec2 n = waveCounts();
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, n))) return;
  const int i = cell.x + n.x * cell.y;
  vec2 u = flow[i].xy;
#if !WAVE_PERIODIC_X
  if (cell.x < n.x - 1)
#endif
    u.x = mixed(u.x, i, wrapped(cell.x + 1, n.x) + n.x * cell.y, 0);
#if !WAVE_PERIODIC_Z
  if (cell.y < n.y - 1)
#endif
    u.y = mixed(u.y, i, cell.x + n.x * wrapped(cell.y + 1, n.y), 1);
  flow[i].xy = u;
}
