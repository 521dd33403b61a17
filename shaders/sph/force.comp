// Acceleration of each particle from its neighbours, the floor, gravity and the downward force.
// Reads PRESSURE_POINT, MOTION_POINT, ACCELERATION.w (rho), CELL_START, floor and walls. Writes ACCELERATION.
// Equations: -sum_j m (p_i/rho_i^2 + p_j/rho_j^2) grad W (momentum-conserving form of thesis 3.17) or, with MEAN_FORCE,
// -1/rho_i sum_j m (p_i + p_j)/(2 rho_j) grad W (thesis 3.17 unchanged); mu/rho_i sum_j m/rho_j (v_j - v_i) laplacian
// W, viscosity kernel (thesis 3.18, with the velocity difference that its text describes); -1/rho_0 sum_j m q grad W for
// pairs that approach each other (particles/collision.glsl); with TENSION that of particles/tension.glsl; above the water
// -downforce (y - eta)^2 (thesis 3.6.2).
// Invariant: the pair terms are antisymmetric up to rounding (not with MEAN_FORCE); the particle itself adds nothing (r = 0).
#include "shared/groups.h"
#include "grid/candidates.glsl"
#include "particles/population.glsl"
#include "particles/boundary.glsl"
#include "particles/collision.glsl"
#include "particles/tension.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = PRESSURE_POINT) uniform samplerBuffer pressure_point;
layout(binding = MOTION_POINT) uniform samplerBuffer motion_point;
#if TENSION
layout(binding = SURFACE_GRADIENT) uniform samplerBuffer surface_gradient;
#endif
layout(std430, binding = ACCELERATION) restrict buffer Acceleration { vec4 acceleration[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= particleCount()) return;
  const Grid g = loadGrid();
  const Support support = makeSupport(g.cell_m);
  const vec4 own = texelFetch(pressure_point, int(i));
  const vec3 v_i = texelFetch(motion_point, int(i)).xyz;
  const float rho_i = acceleration[i].w;
  const ivec3 cell = cellOf(g, own.xyz);

#if MEAN_FORCE
  const float push_factor = 0.5 / rho_i;
  const float pressure_term = own.w / (rho_i * rho_i);
#else
  const float push_factor = sim.mass_kg;
  const float pressure_term = own.w;
#endif
  const float collision_factor = sim.mass_kg / (sim.rest_density_kgpm3 * push_factor);
  const float limit_mps = collisionLimit();

  vec3 push = vec3(0.0);
  vec3 drag = vec3(0.0);
#if TENSION
  const vec3 emptiness = texelFetch(surface_gradient, int(i)).xyz;
  vec3 tensed = vec3(0.0);
#endif
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dx = -1; dx <= 1; ++dx) {
      const CandidateRange range = candidateRange(g, cell, dx, dz);
      const vec3 x = own.xyz + range.shift_m;
      for (int j = range.first; j < range.last; ++j) {
        const vec4 a = texelFetch(pressure_point, j);
        const vec4 b = texelFetch(motion_point, j);
        const vec3 r = fromCandidate(g, x, a.xyz);
        const float r2 = dot(r, r);
        const float q = collision(r, r2, v_i - b.xyz, limit_mps);
#if MEAN_FORCE
        push += (((own.w + a.w) * b.w + collision_factor * q) * pressurePull(r2, support)) * r;
#else
        push += ((own.w + a.w + collision_factor * q) * pressurePull(r2, support)) * r;
#endif
        drag += (b.w * viscosityLaplacian(sqrt(r2), support.H)) * (b.xyz - v_i);
#if TENSION
        tensed += tension(r, r2, emptiness - texelFetch(surface_gradient, j).xyz, support);
#endif
      }
    }
  }

  vec3 a = sim.slope_norm * push_factor * push + sim.viscosity_norm * sim.viscosity_pas / rho_i * drag;
#if TENSION
  a += tensed;
#endif
  a += boundaryAcceleration(own.xyz, v_i, pressure_term, rho_i);
  a.y -= sim.gravity_mps2;
#if COUPLED
  const Floor f = loadFloor();
  const float above_m = max(own.y - (floorHeight(f, own.xz) + f.band_m), 0.0);
  a.y -= sim.downforce_per_m_s2 * above_m * above_m;
#endif
  acceleration[i] = vec4(a, rho_i);
}
