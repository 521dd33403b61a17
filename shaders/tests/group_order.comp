// For tests: records the order in which a device runs work groups, by the numbers that the shader sees
// (server/gpu/shuffled_groups.h).
// Writes Order: the number of groups that have run, and their numbers in that order.
layout(local_size_x = 1) in;

layout(std430, binding = 0) restrict buffer Order {
  uint next;
  uint order[];
};

void main() {
  order[atomicAdd(next, 1u)] = gl_WorkGroupID.x;
}
