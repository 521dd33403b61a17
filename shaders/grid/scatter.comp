// Groups particle indices by cell, in arrival order, and clears the counts of their cells for the next build; those of empty cells are 0.
// Reads CELL_ARRIVAL, CELL_START. Writes CELL_MEMBER, CELL_COUNT.
#include "shared/groups.h"
#include "shared/grid.h"
#include "particles/population.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = CELL_ARRIVAL) uniform usamplerBuffer arrival;
layout(binding = CELL_START) uniform usamplerBuffer cell_start;
layout(std430, binding = CELL_COUNT) restrict writeonly buffer CellCount { uint cell_count_of[]; };
layout(std430, binding = CELL_MEMBER) restrict writeonly buffer CellMember { uint cell_member[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= unsortedCount()) return;
  const uvec2 a = texelFetch(arrival, int(i)).xy;
#if POOL_PARTICLES
  if (a.x == NO_CELL) return;
#endif
  cell_count_of[a.x] = 0u;
  cell_member[texelFetch(cell_start, int(a.x)).x + a.y] = i;
}
