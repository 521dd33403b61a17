// Position-based fluids (Macklin & Mueller 2013, algorithm 1), first step: velocities from gravity and the downward force,
// and the positions that follow from them.
// Reads and writes POSITION (then the predicted position, wrapped on periodic sides but not yet kept out of walls and
// floor) and VELOCITY (then the predicted velocity, consistent with the step from the old to the predicted position).
// Invariant: not faster than max_speed_mps.
#include "shared/groups.h"
#include "common/finite.glsl"
#include "particles/population.glsl"
#include "particles/floor.glsl"
#include "particles/sides.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(std430, binding = POSITION) restrict buffer Position { vec4 position[]; };
layout(std430, binding = VELOCITY) restrict buffer Velocity { vec4 velocity[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= unsortedCount()) return;
  vec4 x = position[i];
  if (!isFinite(x.xyz)) return;  // left for diagnostics to count
  vec4 v = velocity[i];
  v.y -= sim.dt_s * sim.gravity_mps2;
#if COUPLED
  const Floor f = loadFloor();
  const float above_m = max(x.y - (floorHeight(f, x.xz) + f.band_m), 0.0);
  v.y -= sim.dt_s * sim.downforce_per_m_s2 * above_m * above_m;
#endif
  v.xyz *= min(1.0, sim.max_speed_mps / max(length(v.xyz), 1e-6));
  x.xyz += sim.dt_s * v.xyz;
#if FOLLOW
  carryAlong(x.xyz, v.xyz);
#else
#if PERIODIC_X
  wrapAround(x.x, sim.min_x_m, sim.max_x_m);
#endif
#if PERIODIC_Z
  wrapAround(x.z, sim.min_z_m, sim.max_z_m);
#endif
#if PERIODIC_Y
  wrapAround(x.y, sim.min_y_m, sim.max_y_m);
#endif
#endif
  position[i] = x;
  velocity[i] = v;
}
