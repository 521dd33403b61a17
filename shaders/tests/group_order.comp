// For tests: the order in which a device runs work groups, by the numbers that the shader sees
// (server/gpu/shuffled_groups.h).
// Writes Order: how many groups have run, and the number of each in the order of running.
layout(local_size_x = 1) in;

layout(std430, binding = 0) restrict buffer Order {
  uint next;
  uint order[];
};

void main() {
  order[atomicAdd(next, 1u)] = gl_WorkGroupID.x;
}
