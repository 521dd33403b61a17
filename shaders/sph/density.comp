// Density and pressure of each particle.
// Reads SORTED_POSITION, SORTED_VELOCITY, CELL_START, floor and walls. Writes PRESSURE_POINT (position, p/rho^2, with MEAN_FORCE
// p), MOTION_POINT (velocity, m/rho), ACCELERATION.w (rho), NEAR_CANDIDATES, with NEIGHBOUR_FOAM FOAM_SOURCE, with TENSION
// SURFACE_GRADIENT; counts in CROWDED.
// Equations: rho_i = sum_j m W(r_ij) (thesis 3.6), plus the floor's virtual particles, cubic kernel (thesis, algorithm
// 10), and the walls' shares; p_i from the equation of state (sph/pressure.glsl).
// Invariant: rho_i >= m W(0) > 0, so the divisions are safe.
#define COUNT_CROWDED
#define NOTE_NEAR
#include "shared/groups.h"
#include "grid/candidates.glsl"
#include "particles/population.glsl"
#include "particles/floor.glsl"
#include "particles/kernels.glsl"
#include "particles/boundary.glsl"
#include "particles/foam.glsl"
#include "particles/tension.glsl"
#include "sph/pressure.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = SORTED_POSITION) uniform samplerBuffer sorted_position;
layout(binding = SORTED_VELOCITY) uniform samplerBuffer sorted_velocity;
layout(std430, binding = PRESSURE_POINT) restrict writeonly buffer PressurePoint { vec4 pressure_point[]; };
layout(std430, binding = MOTION_POINT) restrict writeonly buffer MotionPoint { vec4 motion_point[]; };
#if NEIGHBOUR_FOAM
layout(std430, binding = FOAM_SOURCE) restrict writeonly buffer FoamSource { float foam_source[]; };
#endif
#if TENSION
layout(std430, binding = SURFACE_GRADIENT) restrict writeonly buffer SurfaceGradient { vec4 surface_gradient[]; };
#endif
layout(std430, binding = ACCELERATION) restrict writeonly buffer Acceleration { vec4 acceleration[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= particleCount()) return;
  const Grid g = loadGrid();
  const Support support = makeSupport(g.cell_m);
  const vec3 x_i = texelFetch(sorted_position, int(i)).xyz;
  const ivec3 cell = cellOf(g, x_i);

  float sum = 0.0;
#if TENSION
  vec3 emptiness = vec3(0.0);
#endif
#if NEIGHBOUR_FOAM
  const float H2 = support.H * support.H;
  float near = -1.0;  // the particle itself is not counted
#endif
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dx = -1; dx <= 1; ++dx) {
      const CandidateRange range = candidateRange(g, cell, dx, dz);
      const vec3 x = x_i + range.shift_m;
      NearBits noted = noneNear();
      for (int j = range.first; j < range.last; ++j) {
        const vec3 r = fromCandidate(g, x, texelFetch(sorted_position, j).xyz);
        const float r2 = dot(r, r);
        sum += densityShape(r2, support);
        noteNear(noted, r2, g);
#if TENSION
        emptiness += surfaceShare(r, r2, support);
#endif
#if NEIGHBOUR_FOAM
        near += step(r2, H2);
#endif
      }
      storeNear(i, dx, dz, range, noted);
    }
  }

  countCrowded();
  endNear(i);

  const float rho = sim.mass_kg * sim.density_norm * sum + boundaryDensity(x_i);
  const float pressure = pressureOf(rho);
#if MEAN_FORCE
  pressure_point[i] = vec4(x_i, pressure);
#else
  pressure_point[i] = vec4(x_i, pressure / (rho * rho));
#endif
#if NEIGHBOUR_FOAM
  foam_source[i] = neighbourFoam(near);
#endif
#if TENSION
  surface_gradient[i] = vec4(emptiness - sim.tension_wall_m5pkg * boundaryGradient(x_i), 0.0);
#endif
  motion_point[i] = vec4(texelFetch(sorted_velocity, int(i)).xyz, sim.mass_kg / rho);
  acceleration[i] = vec4(0.0, 0.0, 0.0, rho);
}
