// Moves the particles by symplectic Euler and keeps them inside (thesis 3.6.2).
#include "particles.glsl"
#include "wave_texture.glsl"
#include "particles/surroundings.glsl"

layout(local_size_x = GROUP) in;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= sim.particle_count) return;
  vec3 v = particle[i].vel.xyz + sim.dt_s * particle[i].acc.xyz;
  v *= min(1.0, sim.max_speed_mps / max(length(v), 1e-6));
  vec3 x = particle[i].pos.xyz + sim.dt_s * v;
  meetSurroundings(x, v);
  particle[i].pos.xyz = x;
  particle[i].vel.xyz = v;
}
