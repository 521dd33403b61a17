// Acceleration of each particle from its neighbours, the floor, gravity and the downward force.
// Reads PRESSURE_POINT, MOTION_POINT, ACCELERATION.w (rho), CELL_START, NEAR_CANDIDATES, floor and walls. Writes ACCELERATION.
// Equations: -sum_j m (p_i/rho_i^2 + p_j/rho_j^2) grad W (momentum-conserving form of thesis 3.17) or, with MEAN_FORCE,
// -1/rho_i sum_j m (p_i + p_j)/(2 rho_j) grad W (thesis 3.17 unchanged); mu/rho_i sum_j m/rho_j (v_j - v_i) laplacian
// W, viscosity kernel (thesis 3.18, with the velocity difference that its text describes); -1/rho_0 sum_j m q grad W for
// pairs that approach each other (particles/collision.glsl); with TENSION that of particles/tension.glsl; above the water
// -downforce (y - eta)^2 (thesis 3.6.2).
// Invariant: the pair terms are antisymmetric up to rounding (not with MEAN_FORCE); the particle itself adds nothing (r = 0).
#define VISIT_NEAR
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

/// Values of the particle, and sums over its pairs.
struct Pairs {
  vec3 v_mps;
  float pressure;  ///< as in PRESSURE_POINT
  float collision_factor;
  float limit_mps;
  Support support;
  vec3 push;
  vec3 drag;
#if TENSION
  vec3 emptiness;
  vec3 tensed;
#endif
};

/// Adds the pair with candidate j; x is the position of the particle, shifted for j's column.
void addPair(inout Pairs p, Grid g, vec3 x, int j) {
  const vec4 a = texelFetch(pressure_point, j);
  const vec4 b = texelFetch(motion_point, j);
  const vec3 r = fromCandidate(g, x, a.xyz);
  const float r2 = dot(r, r);
  const float q = collision(r, r2, p.v_mps - b.xyz, p.limit_mps);
#if MEAN_FORCE
  p.push += (((p.pressure + a.w) * b.w + p.collision_factor * q) * pressurePull(r2, p.support)) * r;
#else
  p.push += ((p.pressure + a.w + p.collision_factor * q) * pressurePull(r2, p.support)) * r;
#endif
  p.drag += (b.w * viscosityLaplacian(sqrt(r2), p.support.H)) * (b.xyz - p.v_mps);
#if TENSION
  p.tensed += tension(r, r2, p.emptiness - texelFetch(surface_gradient, j).xyz, p.support);
#endif
}

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= particleCount()) return;
  const Grid g = loadGrid();
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

  Pairs p;
  p.v_mps = v_i;
  p.pressure = own.w;
  p.collision_factor = sim.mass_kg / (sim.rest_density_kgpm3 * push_factor);
  p.limit_mps = collisionLimit();
  p.support = makeSupport(g.cell_m);
  p.push = vec3(0.0);
  p.drag = vec3(0.0);
#if TENSION
  p.emptiness = texelFetch(surface_gradient, int(i)).xyz;
  p.tensed = vec3(0.0);
#endif
  for (Near near = beforeNear(i); nextNear(near, g, cell);) {
    if (near.j >= 0) addPair(p, g, own.xyz + near.shift_m, near.j);
  }
  for (int dz = firstRow(i); dz <= 1; ++dz) {
    for (int dx = -1; dx <= 1; ++dx) {
      const CandidateRange range = candidateRange(g, cell, dx, dz);
      for (int j = range.first; j < range.last; ++j) addPair(p, g, own.xyz + range.shift_m, j);
    }
  }

  vec3 a = sim.slope_norm * push_factor * p.push + sim.viscosity_norm * sim.viscosity_pas / rho_i * p.drag;
#if TENSION
  a += p.tensed;
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
