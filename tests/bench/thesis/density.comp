// Density and pressure of each particle from the 27 cells around it and the wave (thesis 3.6, 3.9, algorithm 10).
#include "particles.glsl"
#include "wave_texture.glsl"
#include "particles/boundary.glsl"
#include "sph/pressure.glsl"

layout(local_size_x = GROUP) in;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= sim.particle_count) return;
  const Cells c = loadCells();
  const Support support = makeSupport(sim.support_radius_m);
  const vec3 x_i = particle[i].pos.xyz;
  const ivec3 cell = cellOf(c, x_i);
  float sum = 0.0;
  for (int k = 0; k < 27; ++k) {
    uint first, last;
    vec3 shift_m;
    if (!neighbourCell(c, cell + ivec3(k % 3, k / 3 % 3, k / 9) - 1, first, last, shift_m)) continue;
    for (uint at = first; at < last; ++at) {
      const vec3 r = x_i + shift_m - particle[contents[at]].pos.xyz;
      sum += densityShape(dot(r, r), support);
    }
  }
  const float rho = sim.mass_kg * sim.density_norm * sum + boundaryDensity(x_i);
  particle[i].vel.w = pressureOf(rho);
  particle[i].acc.w = rho;
}
