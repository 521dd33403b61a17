// The multiplier of each particle's density constraint C_i = rho_i / rho_0 - 1; without COHESION it is 0 where C_i < 0.
// Reads SORTED_POSITION (the positions of this iteration), CELL_START, floor and walls. Writes PRESSURE_POINT (position, lambda [m^2])
// ACCELERATION.w (rho), NEAR_CANDIDATES, with TENSION SURFACE_GRADIENT; counts in CROWDED.
// Equation: lambda_i = -C_i / (sum_k |grad_k C_i|^2 + softness) (Macklin & Mueller 2013, eq. 11). Floor and walls
// contribute to rho_i and to the particle's own gradient; they do not move.
#define COUNT_CROWDED
#define NOTE_NEAR
#include "shared/groups.h"
#include "particles/population.glsl"
#include "grid/candidates.glsl"
#include "particles/boundary.glsl"
#include "particles/tension.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = SORTED_POSITION) uniform samplerBuffer iterate;
layout(std430, binding = PRESSURE_POINT) restrict writeonly buffer PressurePoint { vec4 pressure_point[]; };
#if TENSION
layout(std430, binding = SURFACE_GRADIENT) restrict writeonly buffer SurfaceGradient { vec4 surface_gradient[]; };
#endif
layout(std430, binding = ACCELERATION) restrict writeonly buffer Acceleration { vec4 acceleration[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= particleCount()) return;
  const Grid g = loadGrid();
  const Support support = makeSupport(g.cell_m);
  const vec3 x_i = texelFetch(iterate, int(i)).xyz;
  const ivec3 cell = cellOf(g, x_i);

  float sum = 0.0;
  float squares = 0.0;
  vec3 pull = vec3(0.0);
#if TENSION
  vec3 emptiness = vec3(0.0);
#endif
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dx = -1; dx <= 1; ++dx) {
      const CandidateRange range = candidateRange(g, cell, dx, dz);
      const vec3 x = x_i + range.shift_m;
      NearBits noted = noneNear();
      for (int j = range.first; j < range.last; ++j) {
        const vec3 r = fromCandidate(g, x, texelFetch(iterate, j).xyz);
        const float r2 = dot(r, r);
        const vec3 p = pressurePull(r2, support) * r;
        sum += densityShape(r2, support);
        pull += p;
        squares += dot(p, p);
        noteNear(noted, r2, g);
#if TENSION
        emptiness += surfaceShare(r, r2, support);
#endif
      }
      storeNear(i, dx, dz, range, noted);
    }
  }

  countCrowded();
  endNear(i);

  const float rho = sim.mass_kg * sim.density_norm * sum + boundaryDensity(x_i);
  const float slope = sim.mass_kg * sim.slope_norm / sim.rest_density_kgpm3;
  const vec3 own = boundaryGradient(x_i) / sim.rest_density_kgpm3 - slope * pull;
  float constraint = rho / sim.rest_density_kgpm3 - 1.0;
#if !COHESION
  constraint = max(constraint, 0.0);
#endif
  const float lambda = -constraint / (dot(own, own) + slope * slope * squares + sim.constraint_softness_pm2);
#if TENSION
  surface_gradient[i] = vec4(emptiness - sim.tension_wall_m5pkg * boundaryGradient(x_i), 0.0);
#endif
  pressure_point[i] = vec4(x_i, lambda);
  acceleration[i] = vec4(0.0, 0.0, 0.0, rho);
}
