// Viscosity between the particles and against the floor, collisions between them, foam, and the sides; ends the step.
// Reads PRESSURE_POINT (position, m/rho), ACCELERATION (velocity, rho), SORTED_POSITION.w (id), SORTED_VELOCITY.w (foam), CELL_START, the
// floor; with TENSION SURFACE_GRADIENT. Writes POSITION, VELOCITY (in sorted order).
// Equation: the weakly compressible solver's viscosity, mu/rho_i sum_j m/rho_j (v_j - v_i) laplacian W (thesis 3.18), and its
// collisions, -1/rho_0 sum_j m q grad W (particles/collision.glsl), and the surface tension of
// particles/tension.glsl, over one step. The gradients of the surface are those before the last correction.
#include "shared/groups.h"
#include "particles/population.glsl"
#include "grid/candidates.glsl"
#include "particles/boundary.glsl"
#include "particles/collision.glsl"
#include "particles/tension.glsl"
#include "common/finite.glsl"
#include "particles/foam.glsl"
#include "particles/surroundings.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = PRESSURE_POINT) uniform samplerBuffer pressure_point;
layout(binding = ACCELERATION) uniform samplerBuffer acceleration;
#if TENSION
layout(binding = SURFACE_GRADIENT) uniform samplerBuffer surface_gradient;
#endif
layout(binding = SORTED_POSITION) uniform samplerBuffer sorted_position;
layout(binding = SORTED_VELOCITY) uniform samplerBuffer sorted_velocity;
layout(std430, binding = POSITION) restrict writeonly buffer Position { vec4 position[]; };
layout(std430, binding = VELOCITY) restrict writeonly buffer Velocity { vec4 velocity[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= particleCount()) return;
  const Grid g = loadGrid();
  const Support support = makeSupport(g.cell_m);
  const vec4 predicted = texelFetch(sorted_position, int(i));
  if (!isFinite(predicted.xyz)) {
    // Left unchanged for diagnostics to count: min() and max() at a wall would turn the NaN into a valid position.
    position[i] = predicted;
    velocity[i] = texelFetch(sorted_velocity, int(i));
    return;
  }
  vec3 x_i = texelFetch(pressure_point, int(i)).xyz;
  const vec4 own = texelFetch(acceleration, int(i));
  const ivec3 cell = cellOf(g, x_i);

  const float limit_mps = collisionLimit();
  vec3 drag = vec3(0.0);
  vec3 push = vec3(0.0);
#if TENSION
  const vec3 emptiness = texelFetch(surface_gradient, int(i)).xyz;
  vec3 tensed = vec3(0.0);
#endif
#if NEIGHBOUR_FOAM
  const float H2 = support.H * support.H;
  float near = -1.0;  // the particle itself is not counted
#endif
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dx = -1; dx <= 1; ++dx) {
      const CandidateRange range = candidateRange(g, cell, dx, dz);
      const vec3 x = x_i + range.shift_m;
      for (int j = range.first; j < range.last; ++j) {
        const vec4 a = texelFetch(pressure_point, j);
        const vec3 r = fromCandidate(g, x, a.xyz);
        const float r2 = dot(r, r);
        const vec3 v_ij = own.xyz - texelFetch(acceleration, j).xyz;
        push += (collision(r, r2, v_ij, limit_mps) * pressurePull(r2, support)) * r;
        drag -= (a.w * viscosityLaplacian(sqrt(r2), support.H)) * v_ij;
#if TENSION
        tensed += tension(r, r2, emptiness - texelFetch(surface_gradient, j).xyz, support);
#endif
#if NEIGHBOUR_FOAM
        near += step(r2, H2);
#endif
      }
    }
  }

  const vec3 a_collisions = sim.slope_norm * sim.mass_kg / sim.rest_density_kgpm3 * push;
  const vec3 a_viscosity = sim.viscosity_norm * sim.viscosity_pas / own.w * drag + floorAcceleration(x_i, own.xyz, 0.0, own.w);
#if TENSION
  vec3 v = own.xyz + sim.dt_s * (a_collisions + a_viscosity + tensed);
#else
  vec3 v = own.xyz + sim.dt_s * (a_collisions + a_viscosity);
#endif
  v *= min(1.0, sim.max_speed_mps / max(length(v), 1e-6));
  if (!meetSurroundings(x_i, v)) {
#if POOL_PARTICLES
    position[i] = vec4(x_i, DEAD_ID);
    velocity[i] = vec4(0.0);
#endif
    return;
  }

#if FOAM
  float foam = foamStep(texelFetch(sorted_velocity, int(i)).w, own.w / sim.rest_density_kgpm3);
#if NEIGHBOUR_FOAM
  foam = max(foam, neighbourFoam(near));
#endif
#else
  const float foam = 0.0;
#endif
  position[i] = vec4(x_i, predicted.w);
  velocity[i] = vec4(v, foam);
}
