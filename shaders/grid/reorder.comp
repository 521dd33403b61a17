// Sorts particles by cell and, inside a cell, by their previous index. Neighbours become contiguous, and a run is
// reproducible bit for bit, because the result does not depend on the order of invocations.
// Reads POSITION, VELOCITY, CELL_ARRIVAL, CELL_START, CELL_MEMBER. Writes SORTED_POSITION, SORTED_VELOCITY.
// Cost: each particle counts the smaller indices in its cell, so n particles in one cell cost n^2, up to ORDERED_MAX
// particles.
#include "shared/groups.h"
#include "shared/grid.h"
#include "particles/population.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = POSITION) uniform samplerBuffer position;
layout(binding = VELOCITY) uniform samplerBuffer velocity;
layout(binding = CELL_ARRIVAL) uniform usamplerBuffer arrival;
layout(binding = CELL_START) uniform usamplerBuffer cell_start;
layout(binding = CELL_MEMBER) uniform usamplerBuffer cell_member;
layout(std430, binding = SORTED_POSITION) restrict writeonly buffer SortedPosition { vec4 sorted_position[]; };
layout(std430, binding = SORTED_VELOCITY) restrict writeonly buffer SortedVelocity { vec4 sorted_velocity[]; };

#if POOL_PARTICLES
/// In a pool the index of a particle depends on the order of invocations; its position does not.
bool isBefore(vec3 a, uint i, vec3 b, uint j) {
  return a.x < b.x || (a.x == b.x && (a.z < b.z || (a.z == b.z && (a.y < b.y || (a.y == b.y && i < j)))));
}
#endif

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= unsortedCount()) return;
  const uvec2 a = texelFetch(arrival, int(i)).xy;
#if POOL_PARTICLES
  if (a.x == NO_CELL) return;
#endif
  const int cell = int(a.x);
  const int first = int(texelFetch(cell_start, cell).x);
  // Positions after the last cell are not finite and need no order.
  int last = a.x < sim.cell_count ? int(texelFetch(cell_start, cell + 1).x) : first;
  uint slot = uint(first);
  if (a.x == sim.cell_count || last - first > ORDERED_MAX) {
    slot += a.y;
    last = first;
  }
  const vec4 own = texelFetch(position, int(i));
  for (int k = first; k < last; ++k) {
    const uint other = texelFetch(cell_member, k).x;
#if POOL_PARTICLES
    slot += isBefore(texelFetch(position, int(other)).xyz, other, own.xyz, i) ? 1u : 0u;
#else
    slot += other < i ? 1u : 0u;
#endif
  }
  sorted_position[slot] = own;
  sorted_velocity[slot] = texelFetch(velocity, int(i));
}
