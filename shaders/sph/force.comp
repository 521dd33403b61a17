// Acceleration of each particle from its neighbours, the floor, gravity and the downward force.
// Reads PRESSURE_POINT, MOTION_POINT, ACCELERATION.w (rho), CELL_START, the floor. Writes ACCELERATION.
// Equations: -sum_j m (p_i/rho_i^2 + p_j/rho_j^2) grad W, spiky (momentum-conserving form of thesis 3.17);
// mu/rho_i sum_j m/rho_j (v_j - v_i) laplacian W, viscosity kernel (thesis 3.18 with the difference its text means); above the
// water -downforce (y - eta)^2 (thesis 3.6.2).
// Invariant: the pair terms are antisymmetric up to rounding; the particle itself adds nothing (r = 0).
// variants: PERIODIC_X=1 PERIODIC_Z=1 COUPLED=1 WAVE_PERIODIC=1 LATTICE=5 | PERIODIC_X=0 PERIODIC_Z=0 COUPLED=0 WAVE_PERIODIC=0 LATTICE=3
#include "shared/groups.h"
#include "include/candidates.glsl"
#include "include/floor_lattice.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = PRESSURE_POINT) uniform samplerBuffer pressure_point;
layout(binding = MOTION_POINT) uniform samplerBuffer motion_point;
layout(std430, binding = ACCELERATION) restrict buffer Acceleration { vec4 acceleration[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= sim.particle_count) return;
  const Grid g = loadGrid();
  const float H = g.cell_m;
  const vec4 own = texelFetch(pressure_point, int(i));
  const vec3 v_i = texelFetch(motion_point, int(i)).xyz;
  const float rho_i = acceleration[i].w;
  const ivec3 cell = cellOf(g, own.xyz);

  vec3 push = vec3(0.0);
  vec3 drag = vec3(0.0);
  for (int row = 0; row < 9; ++row) {
    for (int segment = 0; segment < ROW_SEGMENTS; ++segment) {
      const CandidateRange range = candidateRange(g, cell, row, segment);
      const vec3 x = own.xyz + range.shift_m;
      for (int j = range.first; j < range.last; ++j) {
        const vec4 a = texelFetch(pressure_point, j);
        const vec4 b = texelFetch(motion_point, j);
        const vec3 r = x - a.xyz;
        const float r2 = dot(r, r);
        const float inverse_r = inversesqrt(max(r2, 1e-12));
        const float distance_m = r2 * inverse_r;
        push += ((own.w + a.w) * spikySlope(distance_m, H) * inverse_r) * r;
        drag += (b.w * viscosityLaplacian(distance_m, H)) * (b.xyz - v_i);
      }
    }
  }

  vec3 a = sim.spiky_norm * (sim.mass_kg * push + sim.viscosity_pas / rho_i * drag);
  a += floorAcceleration(own.xyz, v_i, own.w, rho_i);
  a.y -= sim.gravity_mps2;
#if COUPLED
  const Floor f = loadFloor();
  const float above_m = max(own.y - (floorHeight(f, own.xz) + f.band_m), 0.0);
  a.y -= sim.downforce_per_m_s2 * above_m * above_m;
#endif
  acceleration[i] = vec4(a, rho_i);
}
