// For tests: writes each invocation's index plus an offset, and counts the invocations inside and outside the guard.
// Reads uniforms item_count, offset. Writes VALUES [item_count], COUNTS [2] = (inside, outside).
layout(local_size_x = GROUP) in;

layout(location = 0) uniform uint item_count;
layout(location = 1) uniform int offset;

layout(std430, binding = 0) restrict writeonly buffer Values { int values[]; };
layout(std430, binding = 1) restrict buffer Counts { uint counts[2]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= item_count) {
    atomicAdd(counts[1], 1u);
    return;
  }
  atomicAdd(counts[0], 1u);
  values[i] = int(i) + offset;
}
