// Exclusive prefix sum, last of three: adds the sum of the blocks before, and closes the array with the particle count.
// Reads BLOCK_TOTAL. Adds to CELL_START [cell_count + 1].
#include "shared/groups.h"
#include "shared/sim_uniforms.h"

layout(local_size_x = SCAN_GROUP) in;

layout(binding = BLOCK_TOTAL) uniform usamplerBuffer block_total;
layout(std430, binding = CELL_START) restrict buffer CellStart { uint cell_start[]; };

void main() {
  const uint cell = gl_GlobalInvocationID.x;
  if (cell < sim.cell_count) cell_start[cell] += texelFetch(block_total, int(cell / SCAN_BLOCK)).x;
  if (cell == sim.cell_count) cell_start[cell] = sim.particle_count;
}
