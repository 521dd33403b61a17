// Counts the particles of each cell and notes each particle's cell and arrival number.
// Reads POSITION [particle_count]. Adds to CELL_COUNT [cell_count] (cleared before). Writes CELL_ARRIVAL
// [particle_count] = (cell, arrival). The arrival order is not repeatable; grid/reorder.comp makes the final order so.
// variants: PERIODIC_X=1 PERIODIC_Z=1
#include "shared/groups.h"
#include "include/grid_hash.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = POSITION) uniform samplerBuffer position;
layout(std430, binding = CELL_COUNT) restrict buffer CellCount { uint cell_count_of[]; };
layout(std430, binding = CELL_ARRIVAL) restrict writeonly buffer CellArrival { uvec2 arrival[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= sim.particle_count) return;
  const Grid g = loadGrid();
  const uint cell = uint(flatCell(g, cellOf(g, texelFetch(position, int(i)).xyz)));
  arrival[i] = uvec2(cell, atomicAdd(cell_count_of[cell], 1u));
}
