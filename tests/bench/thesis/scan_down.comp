// Exclusive prefix sum of `count` into `start` (Blelloch 1990), one level of the way down per dispatch.
#include "particles.glsl"

layout(local_size_x = GROUP) in;

layout(location = 0) uniform uint level;

void main() {
  const uint left = ((2u * gl_GlobalInvocationID.x + 1u) << level) - 1u;
  const uint right = left + (1u << level);
  if (right >= CELLS) return;
  const uint before = right + 1u == CELLS && (2u << level) == CELLS ? 0u : start[right];  // the total becomes 0
  start[right] = before + start[left];
  start[left] = before;
}
