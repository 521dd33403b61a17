// Moves each particle by the corrections of the constraints around it, then out of walls and floor.
// Reads PRESSURE_POINT (position, lambda), CELL_START, NEAR_CANDIDATES, floor and walls. Writes MOTION_POINT (position of the next iteration).
// Equation: dx_i = sum_j (lambda_i + lambda_j) m/rho_0 grad W (Macklin & Mueller 2013, eq. 12) + lambda_i/rho_0 grad rho_boundary.
// Invariant: one iteration moves a particle by at most a quarter of the spacing, except for the lift to the floor.
#define VISIT_NEAR
#include "shared/groups.h"
#include "particles/population.glsl"
#include "grid/candidates.glsl"
#include "particles/boundary.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = PRESSURE_POINT) uniform samplerBuffer pressure_point;
layout(std430, binding = MOTION_POINT) restrict writeonly buffer MotionPoint { vec4 motion_point[]; };

/// What candidate j adds to the correction of the particle at x, without norms. `lambda`: of the particle.
vec3 pairCorrection(Grid g, Support support, vec3 x, float lambda, int j) {
  const vec4 a = texelFetch(pressure_point, j);
  const vec3 r = fromCandidate(g, x, a.xyz);
  return ((lambda + a.w) * pressurePull(dot(r, r), support)) * r;
}

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= particleCount()) return;
  const Grid g = loadGrid();
  const Support support = makeSupport(g.cell_m);
  const vec4 own = texelFetch(pressure_point, int(i));
  const ivec3 cell = cellOf(g, own.xyz);

  vec3 sum = vec3(0.0);
  for (Near near = beforeNear(i); nextNear(near, g, cell);) {
    if (near.j >= 0) sum -= pairCorrection(g, support, own.xyz + near.shift_m, own.w, near.j);
  }
  for (int dz = firstRow(i); dz <= 1; ++dz) {
    for (int dx = -1; dx <= 1; ++dx) {
      const CandidateRange range = candidateRange(g, cell, dx, dz);
      for (int j = range.first; j < range.last; ++j) sum -= pairCorrection(g, support, own.xyz + range.shift_m, own.w, j);
    }
  }

  vec3 move = sim.mass_kg * sim.slope_norm / sim.rest_density_kgpm3 * sum;
  move += min(own.w, 0.0) / sim.rest_density_kgpm3 * boundaryGradient(own.xyz);
  move *= min(1.0, 0.25 * sim.spacing_m / max(length(move), 1e-9));
  vec3 x = own.xyz + move;
#if PERIODIC_X == 0
  x.x = clamp(x.x, sim.min_x_m, sim.max_x_m);
#endif
#if PERIODIC_Z == 0
  x.z = clamp(x.z, sim.min_z_m, sim.max_z_m);
#endif
#if PERIODIC_Y == 0
  x.y = max(x.y, floorHeight(loadFloor(), x.xz) + sim.floor_gap_m);
  x.y = clamp(x.y, sim.min_y_m, sim.max_y_m);
#endif
  motion_point[i] = vec4(x, 0.0);
}
