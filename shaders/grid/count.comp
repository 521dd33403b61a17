// Counts the particles of each cell and notes each particle's cell and arrival number.
// Reads POSITION [unsortedCount()]. Adds to CELL_COUNT [cell_count + 1] (the last entry counts positions without a cell)
// and to RUN_TOTAL, both 0 before. Writes CELL_ARRIVAL = (cell, arrival). Absorbed particles have NO_CELL and are dropped
// here; particles whose position is not finite are counted after the last cell. The order of arrival is not
// reproducible; grid/reorder.comp makes the final order reproducible.
#include "shared/groups.h"
#include "grid/grid_hash.glsl"
#include "particles/population.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = POSITION) uniform samplerBuffer position;
layout(std430, binding = CELL_COUNT) restrict buffer CellCount { uint cell_count_of[]; };
layout(std430, binding = RUN_TOTAL) restrict buffer RunTotal { uint run_total[]; };
layout(std430, binding = CELL_ARRIVAL) restrict writeonly buffer CellArrival { uvec2 arrival[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= unsortedCount()) return;
  const Grid g = loadGrid();
  const vec4 x = texelFetch(position, int(i));
#if POOL_PARTICLES
  if (x.w == DEAD_ID) {
    arrival[i] = uvec2(NO_CELL, 0u);
    return;
  }
#endif
  const uint cell = hasCell(x.xyz) ? uint(flatCell(g, cellOf(g, x.xyz))) : sim.cell_count;
  atomicAdd(run_total[cell / SCAN_RUN], 1u);
  arrival[i] = uvec2(cell, atomicAdd(cell_count_of[cell], 1u));
}
