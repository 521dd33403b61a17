// Test of a device before its first use: uses each feature that the program's shaders rely on once.
// Reads PROBE_TEXELS [64] and the uniform block Probe. Writes result[64], invocation i: the sum of its group's texels times
// `factor`, plus what was stored in `stored[i]`. Adds the number of invocations to `count`.
layout(local_size_x = 32) in;

layout(std140, binding = 0) uniform Probe { uint factor; };
layout(binding = 2) uniform usamplerBuffer texels;
layout(std430, binding = 0) restrict readonly buffer Stored { uint stored[]; };
layout(std430, binding = 1) restrict buffer Result { uint count; uint result[]; };

shared uint values[32];

void main() {
  const uint i = gl_GlobalInvocationID.x;
  const uint lane = gl_LocalInvocationID.x;
  values[lane] = texelFetch(texels, int(i)).x;
  memoryBarrierShared();
  barrier();
  uint sum = 0u;
  for (uint k = 0u; k < 32u; ++k) sum += values[k];
  result[i] = sum * factor + stored[i];
  atomicAdd(count, 1u);
}
