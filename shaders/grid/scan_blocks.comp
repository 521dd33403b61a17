// Exclusive prefix sum, first of three passes: each group scans blocks of SCAN_BLOCK cells and writes their totals.
// Reads CELL_COUNT [cell_count + 1]. Writes CELL_START (sum of the cells before it in its block), BLOCK_TOTAL.
// Algorithm: as Blelloch's, with a serial run of SCAN_ITEMS per invocation, then Hillis & Steele over the group in
// shared memory.
#include "shared/groups.h"
#include "shared/sim_uniforms.h"

layout(local_size_x = SCAN_GROUP) in;

layout(binding = CELL_COUNT) uniform usamplerBuffer cell_count_of;
layout(std430, binding = CELL_START) restrict writeonly buffer CellStart { uint cell_start[]; };
layout(std430, binding = BLOCK_TOTAL) restrict writeonly buffer BlockTotal { uint block_total[]; };

shared uint sums[SCAN_GROUP];

void scan(uint block) {
  const uint lane = gl_LocalInvocationID.x;
  const uint first = block * SCAN_BLOCK + lane * SCAN_ITEMS;
  uint before[SCAN_ITEMS];
  uint total = 0u;
  for (uint k = 0u; k < SCAN_ITEMS; ++k) {
    before[k] = total;
    total += first + k <= sim.cell_count ? texelFetch(cell_count_of, int(first + k)).x : 0u;
  }
  sums[lane] = total;
  barrier();
  for (uint offset = 1u; offset < SCAN_GROUP; offset *= 2u) {
    const uint add = lane >= offset ? sums[lane - offset] : 0u;
    barrier();
    sums[lane] += add;
    barrier();
  }
  const uint base = sums[lane] - total;
  for (uint k = 0u; k < SCAN_ITEMS; ++k) {
    if (first + k <= sim.cell_count) cell_start[first + k] = base + before[k];
  }
  if (lane == SCAN_GROUP - 1u) block_total[block] = sums[lane];
}

void main() {
  const uint block_count = sim.cell_count / SCAN_BLOCK + 1u;
  for (uint block = gl_WorkGroupID.x; block < block_count; block += gl_NumWorkGroups.x) scan(block);
}
