// Exclusive prefix sum, second of two passes: an invocation sums the cells of a run.
// Reads CELL_COUNT [cell_count + 1, in texels of four], RUN_TOTAL (sum of the runs before). Writes CELL_START [cell_count + 1]; clears
// RUN_TOTAL for the next build.
// Four cells are read and written at a time: llvmpipe stores by lane.
// The dispatch may have fewer invocations than runs (MAX_GROUPS): each handles several with a stride.
#include "shared/groups.h"
#include "shared/sim_uniforms.h"

layout(local_size_x = SCAN_RUNS_GROUP) in;

layout(binding = CELL_COUNT) uniform usamplerBuffer cell_count_of;
layout(std430, binding = RUN_TOTAL) restrict buffer RunTotal { uint run_total[]; };
layout(std430, binding = CELL_START) restrict writeonly buffer CellStart { uvec4 cell_start[]; };

void main() {
  const uint run_count = sim.cell_count / SCAN_RUN + 1u;
  const uint stride = gl_NumWorkGroups.x * SCAN_RUNS_GROUP;
  const int fours_count = int(sim.cell_count / 4u + 1u);
  for (uint run = gl_GlobalInvocationID.x; run < run_count; run += stride) {
    uint before = run_total[run];
    run_total[run] = 0u;
    const int begin = int(run) * SCAN_ITEMS;
    for (int k = begin; k < min(begin + SCAN_ITEMS, fours_count); ++k) {
      const uvec4 count = texelFetch(cell_count_of, k);
      const uvec4 sums = before + uvec4(0u, count.x, count.x + count.y, count.x + count.y + count.z);
      cell_start[k] = sums;
      before = sums.w + count.w;
    }
  }
}
