// Moves particles into cell order, inside a cell by their previous index: neighbours become contiguous, and a run repeats
// bit for bit because the order no longer depends on which invocation came first.
// Reads POSITION, VELOCITY, CELL_ARRIVAL, CELL_START, CELL_MEMBER. Writes SORTED_POSITION, SORTED_VELOCITY.
// Cost: a particle counts the smaller indices in its cell, so n particles in one cell cost n^2, as their forces do.
#include "shared/groups.h"
#include "shared/sim_uniforms.h"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = POSITION) uniform samplerBuffer position;
layout(binding = VELOCITY) uniform samplerBuffer velocity;
layout(binding = CELL_ARRIVAL) uniform usamplerBuffer arrival;
layout(binding = CELL_START) uniform usamplerBuffer cell_start;
layout(binding = CELL_MEMBER) uniform usamplerBuffer cell_member;
layout(std430, binding = SORTED_POSITION) restrict writeonly buffer SortedPosition { vec4 sorted_position[]; };
layout(std430, binding = SORTED_VELOCITY) restrict writeonly buffer SortedVelocity { vec4 sorted_velocity[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= sim.particle_count) return;
  const int cell = int(texelFetch(arrival, int(i)).x);
  const int first = int(texelFetch(cell_start, cell).x);
  const int last = int(texelFetch(cell_start, cell + 1).x);
  uint slot = uint(first);
  for (int k = first; k < last; ++k) slot += texelFetch(cell_member, k).x < i ? 1u : 0u;
  sorted_position[slot] = texelFetch(position, int(i));
  sorted_velocity[slot] = texelFetch(velocity, int(i));
}
