// Puts the index of each particle into its cell's part of `contents`. Leaves `count` at zero.
#include "particles.glsl"

layout(local_size_x = GROUP) in;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= sim.particle_count) return;
  const int cell = flatCell(cellOf(loadCells(), particle[i].pos.xyz));
  contents[start[cell] + atomicAdd(count[cell], 0xffffffffu) - 1u] = i;
}
