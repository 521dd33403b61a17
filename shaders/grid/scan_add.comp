// Exclusive prefix sum, last of three passes: adds the sum of the blocks before. The last entry is the number of
// particles in cells.
// Reads BLOCK_TOTAL, CELL_COUNT. Adds to CELL_START [cell_count + 1]; in a pool also writes POOL_LIVE, which includes
// particles without a cell.
// The dispatch may have fewer invocations than cells (MAX_GROUPS): each handles several cells with a stride.
#include "shared/groups.h"
#include "shared/sim_uniforms.h"

layout(local_size_x = SCAN_GROUP) in;

layout(binding = BLOCK_TOTAL) uniform usamplerBuffer block_total;
layout(std430, binding = CELL_START) restrict buffer CellStart { uint cell_start[]; };
#if POOL_PARTICLES
#include "shared/pool.h"
layout(binding = CELL_COUNT) uniform usamplerBuffer cell_count_of;
layout(std430, binding = POOL) restrict buffer Pool { uint pool[]; };
#endif

void main() {
  const uint cell_count = sim.cell_count;
  const uint stride = gl_NumWorkGroups.x * SCAN_GROUP;
  for (uint cell = gl_GlobalInvocationID.x; cell <= cell_count; cell += stride) {
    const uint start = cell_start[cell] + texelFetch(block_total, int(cell / SCAN_BLOCK)).x;
    cell_start[cell] = start;
#if POOL_PARTICLES
    if (cell == cell_count) pool[POOL_LIVE] = start + texelFetch(cell_count_of, int(cell)).x;
#endif
  }
}
