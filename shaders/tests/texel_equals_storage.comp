// For tests: counts the items for which texelFetch and the storage load differ in any bit.
// Reads TEXELS [item_count] both ways. Adds to DIFFERENCES [1].
#include "tests/block.glsl"
layout(local_size_x = 32, local_size_y = 2) in;

layout(binding = 3) uniform samplerBuffer texels;
layout(std430, binding = 0) restrict readonly buffer Storage { vec4 stored[]; };
layout(std430, binding = 1) restrict buffer Differences { uint difference_count; };

void main() {
  const uint i = gl_GlobalInvocationID.x + 64u * gl_GlobalInvocationID.y;
  if (i >= check.item_count) return;
  const vec4 scaled = check.gain * texelFetch(texels, int(i));
  if (floatBitsToUint(scaled) != floatBitsToUint(check.gain * stored[i])) atomicAdd(difference_count, 1u);
}
