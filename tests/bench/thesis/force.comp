// Acceleration of each particle from the 27 cells around it, the wave, gravity and the downward force (thesis 3.17, 3.18,
// 3.6.2, 3.6.4); the pair terms are those of sph/force.comp.
#include "particles.glsl"
#include "wave_texture.glsl"
#include "particles/boundary.glsl"
#include "particles/collision.glsl"

layout(local_size_x = GROUP) in;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= sim.particle_count) return;
  const Cells c = loadCells();
  const Support support = makeSupport(sim.support_radius_m);
  const Particle own = particle[i];
  const float rho_i = own.acc.w;
  const float term_i = own.vel.w / (rho_i * rho_i);
  const float limit_mps = collisionLimit();
  const ivec3 cell = cellOf(c, own.pos.xyz);
  vec3 push = vec3(0.0);
  vec3 drag = vec3(0.0);
  for (int k = 0; k < 27; ++k) {
    uint first, last;
    vec3 shift_m;
    if (!neighbourCell(c, cell + ivec3(k % 3, k / 3 % 3, k / 9) - 1, first, last, shift_m)) continue;
    for (uint at = first; at < last; ++at) {
      const uint j = contents[at];
      const vec3 r = own.pos.xyz + shift_m - particle[j].pos.xyz;
      const vec3 v_j = particle[j].vel.xyz;
      const float p_j = particle[j].vel.w;
      const float rho_j = particle[j].acc.w;
      const float r2 = dot(r, r);
#if MEAN_FORCE
      const float pressure = (own.vel.w + p_j) / (2.0 * rho_i * rho_j);
#else
      const float pressure = term_i + p_j / (rho_j * rho_j);
#endif
      push += ((pressure + collision(r, r2, own.vel.xyz - v_j, limit_mps) / sim.rest_density_kgpm3) * pressurePull(r2, support)) * r;
      drag += (viscosityLaplacian(sqrt(r2), support.H) / rho_j) * (v_j - own.vel.xyz);
    }
  }
  vec3 a = sim.mass_kg * (sim.slope_norm * push + sim.viscosity_norm * sim.viscosity_pas / rho_i * drag);
  a += boundaryAcceleration(own.pos.xyz, own.vel.xyz, term_i, rho_i);
  a.y -= sim.gravity_mps2;
#if COUPLED
  const float above_m = max(own.pos.y - (floorHeight(loadFloor(), own.pos.xz) + sim.band_m), 0.0);
  a.y -= sim.downforce_per_m_s2 * above_m * above_m;
#endif
  particle[i].acc.xyz = a;
}
