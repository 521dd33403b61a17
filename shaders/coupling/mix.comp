// Water that particles brought back in this tick mixes with the columns that it fell into: its velocity becomes part of theirs.
// Reads ELEVATION [nx x nz, units] (the water is in it), BED, LANDED_WATER. Changes FLOW [nx x nz, velocities at the faces
// toward +x and +z, m/s].
// Equation: u' = (h u + m) / (h + dh), h + dh the water at a face now, dh and m what fell on it and its momentum; means of both
// cells. The mean is between u and the velocity of what fell, so it adds no energy.
#include "shared/groups.h"
#include "shared/pool.h"
#include "wave/shallow_column.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(binding = LANDED_WATER) uniform isamplerBuffer landed_water;
layout(std430, binding = FLOW) restrict buffer Flows { vec4 flow[]; };

/// Word of what landed on cell i.
int landed(int i, int word) { return texelFetch(landed_water, LANDED_WORDS * i + word).x; }

float waterOf(int i) { return columnOf(i, texelFetch(elevation, i).x).water_m; }

/// Velocity at the face between two cells. `axis`: 0 along x, 1 along z.
float mixed(float u_mps, int here, int there, int axis) {
  const int landed_units = landed(here, 0) + landed(there, 0);
  if (landed_units <= 0) return u_mps;
  const float momentum = float(landed(here, 1 + axis) + landed(there, 1 + axis)) / MOMENTUM_UNITS;
  const float landed_m = float(landed_units) * ELEVATION_UNIT_M;
  const float water_m = max(waterOf(here) + waterOf(there), landed_m);
  return u_mps + (momentum - landed_m * u_mps) / water_m;
}

void mixAt(ivec2 cell, ivec2 n) {
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

void main() {
  const ivec2 n = waveCounts();
  const int x = int(gl_GlobalInvocationID.x);
  const int first_z = WAVE_STRIP * int(gl_GlobalInvocationID.y);
  if (x >= n.x || first_z >= n.y) return;
  const int x_after = wrapped(x + 1, n.x);
  uint rows = 0u;
  int here = landed(x + n.x * first_z, 0);
  for (int z = first_z; z < min(first_z + WAVE_STRIP, n.y); ++z) {
    const int after = landed(x + n.x * wrapped(z + 1, n.y), 0);
    if (here + landed(x_after + n.x * z, 0) > 0 || here + after > 0) rows |= 1u << uint(z - first_z);
    here = after;
  }
  for (; rows != 0u; rows &= rows - 1u) mixAt(ivec2(x, first_z + findLSB(rows)), n);
}
