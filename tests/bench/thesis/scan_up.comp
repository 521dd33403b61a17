// Exclusive prefix sum of `count` into `start` (Blelloch 1990), one level of the way up per dispatch.
#include "particles.glsl"

layout(local_size_x = GROUP) in;

layout(location = 0) uniform uint level;

void main() {
  const uint left = ((2u * gl_GlobalInvocationID.x + 1u) << level) - 1u;
  const uint right = left + (1u << level);
  if (right >= CELLS) return;
  if (level == 0u) {
    start[left] = count[left];
    start[right] = count[left] + count[right];
  } else {
    start[right] += start[left];
  }
}
