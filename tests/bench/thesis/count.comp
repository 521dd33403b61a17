// Counts the particles of each cell. `count` is zero before: fill.comp counts down again.
#include "particles.glsl"

layout(local_size_x = GROUP) in;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= sim.particle_count) return;
  atomicAdd(count[flatCell(cellOf(loadCells(), particle[i].pos.xyz))], 1u);
}
