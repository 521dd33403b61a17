// Exclusive prefix sum, second of three passes: one group turns the block totals into sums of the blocks before,
// SCAN_GROUP blocks at a time.
// Reads and writes BLOCK_TOTAL [ceil((cell_count + 1) / SCAN_BLOCK)].
#include "shared/groups.h"
#include "shared/sim_uniforms.h"

layout(local_size_x = SCAN_GROUP) in;

layout(std430, binding = BLOCK_TOTAL) restrict buffer BlockTotal { uint block_total[]; };

shared uint sums[SCAN_GROUP];

void main() {
  const uint lane = gl_LocalInvocationID.x;
  const uint block_count = sim.cell_count / SCAN_BLOCK + 1u;
  uint carried = 0u;
  for (uint chunk = 0u; chunk < block_count; chunk += SCAN_GROUP) {
    const uint i = chunk + lane;
    const uint own = i < block_count ? block_total[i] : 0u;
    sums[lane] = own;
    barrier();
    for (uint offset = 1u; offset < SCAN_GROUP; offset *= 2u) {
      const uint add = lane >= offset ? sums[lane - offset] : 0u;
      barrier();
      sums[lane] += add;
      barrier();
    }
    if (i < block_count) block_total[i] = carried + sums[lane] - own;
    carried += sums[SCAN_GROUP - 1u];
    barrier();
  }
}
