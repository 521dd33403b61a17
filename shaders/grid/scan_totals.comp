// Exclusive prefix sum, first of two passes: one group turns the totals of runs into sums of the runs before. An invocation sums
// neighbouring runs; then Hillis & Steele over the group in shared memory.
// Reads and writes RUN_TOTAL [ceil((cell_count + 1) / SCAN_RUN)]; in a pool also writes POOL_LIVE, which includes particles without a
// cell.
#include "shared/groups.h"
#include "shared/sim_uniforms.h"

layout(local_size_x = SCAN_GROUP) in;

layout(std430, binding = RUN_TOTAL) restrict buffer RunTotal { uint run_total[]; };
#if POOL_PARTICLES
#include "shared/pool.h"
layout(std430, binding = POOL) restrict buffer Pool { uint pool[]; };
#endif

shared uint sums[SCAN_GROUP];

void main() {
  const uint lane = gl_LocalInvocationID.x;
  const uint run_count = sim.cell_count / SCAN_RUN + 1u;
  const uint share = (run_count + SCAN_GROUP - 1u) / SCAN_GROUP;
  const uint begin = share * lane;
  const uint end = min(begin + share, run_count);
  uint total = 0u;
  for (uint run = begin; run < end; ++run) total += run_total[run];
  sums[lane] = total;
  barrier();
  for (uint offset = 1u; offset < SCAN_GROUP; offset *= 2u) {
    const uint add = lane >= offset ? sums[lane - offset] : 0u;
    barrier();
    sums[lane] += add;
    barrier();
  }
  uint before = sums[lane] - total;
  for (uint run = begin; run < end; ++run) {
    const uint own = run_total[run];
    run_total[run] = before;
    before += own;
  }
#if POOL_PARTICLES
  if (lane == SCAN_GROUP - 1u) pool[POOL_LIVE] = sums[lane];
#endif
}
