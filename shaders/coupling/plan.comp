// Sets the sizes of the substep's indirect dispatches, emission first, then particles. One invocation.
// Reads and writes POOL. If the pool has no room for all new particles, none is emitted, and this is counted: which ones
// come first must not depend on the order of invocations.
// Invariant: POOL_EMITTED - POOL_ABSORBED is the number of particles alive.
#include "shared/groups.h"
#include "shared/pool.h"
#include "shared/sim_uniforms.h"

layout(local_size_x = 1) in;

layout(std430, binding = POOL) restrict buffer Pool { uint pool[]; };

void arguments(uint at, uint x_groups, uint y_groups) {
  pool[at] = x_groups;
  pool[at + 1u] = y_groups;
  pool[at + 2u] = x_groups > 0u ? 1u : 0u;
}

uint groupsOf(uint items, uint size) { return (items + size - 1u) / size; }

void main() {
  const uint live = pool[POOL_LIVE];
  uint wanted = pool[POOL_WANTED];
  if (live + wanted > sim.pool_capacity_count) {
    wanted = 0u;
    pool[POOL_REFUSED] += 1u;
  }
  const uint count = live + wanted;
  const bool any_wanted = wanted > 0u;
  pool[POOL_WANTED] = 0u;
  pool[POOL_EMITTING] = wanted;
  pool[POOL_NEXT] = live;
  pool[POOL_COUNT] = count;
  pool[POOL_LIVE] = 0u;  // counted by the sort
  pool[POOL_EMITTED] += wanted;
  arguments(POOL_EMIT_ARGS, groupsOf(wanted, POOL_GROUP), any_wanted ? 1u : 0u);
  const bool any_particle = count > 0u;
  arguments(POOL_PARTICLE_ARGS, groupsOf(count, POOL_GROUP), any_particle ? 1u : 0u);
  arguments(POOL_CELL_ARGS, any_particle ? min(groupsOf(sim.cell_count + 1u, SCAN_GROUP), MAX_GROUPS) : 0u, any_particle ? 1u : 0u);
  arguments(POOL_BLOCK_ARGS, any_particle ? groupsOf(sim.cell_count + 1u, POOL_SCAN_BLOCK) : 0u, any_particle ? 1u : 0u);
  arguments(POOL_ONE_ARGS, any_particle ? 1u : 0u, any_particle ? 1u : 0u);
}
