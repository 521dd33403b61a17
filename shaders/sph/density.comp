// Density and pressure of each particle.
// Reads SORTED_POSITION, SORTED_VELOCITY, CELL_START, the floor. Writes PRESSURE_POINT (position, p/rho^2), MOTION_POINT
// (velocity, m/rho) and ACCELERATION.w (rho).
// Equations: rho_i = sum_j m W(r_ij) (thesis 3.6), plus the floor's virtual particles, cubic kernel (thesis, algorithm
// 10); p_i = max(k (rho_i - rho_0), 0) (thesis 3.9, clamped: water does not pull).
// Invariant: rho_i >= m W(0) > 0, so the divisions are safe.
// variants: PERIODIC_X=1 PERIODIC_Z=1 COUPLED=1 POOL_PARTICLES=0 WAVE_PERIODIC_X=1 WAVE_PERIODIC_Z=1 LATTICE=5 KERNEL_SET=3 | PERIODIC_X=0 PERIODIC_Z=0 COUPLED=1 POOL_PARTICLES=1 WAVE_PERIODIC_X=0 WAVE_PERIODIC_Z=0 LATTICE=3 KERNEL_SET=3 | PERIODIC_X=0 PERIODIC_Z=0 COUPLED=0 POOL_PARTICLES=0 WAVE_PERIODIC_X=0 WAVE_PERIODIC_Z=0 LATTICE=3 KERNEL_SET=1 | PERIODIC_X=0 PERIODIC_Z=0 COUPLED=0 POOL_PARTICLES=0 WAVE_PERIODIC_X=0 WAVE_PERIODIC_Z=0 LATTICE=3 KERNEL_SET=2
#include "shared/groups.h"
#include "include/candidates.glsl"
#include "include/population.glsl"
#include "include/floor.glsl"
#include "include/kernels.glsl"
#include "include/floor_lattice.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = SORTED_POSITION) uniform samplerBuffer sorted_position;
layout(binding = SORTED_VELOCITY) uniform samplerBuffer sorted_velocity;
layout(std430, binding = PRESSURE_POINT) restrict writeonly buffer PressurePoint { vec4 pressure_point[]; };
layout(std430, binding = MOTION_POINT) restrict writeonly buffer MotionPoint { vec4 motion_point[]; };
layout(std430, binding = ACCELERATION) restrict writeonly buffer Acceleration { vec4 acceleration[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= particleCount()) return;
  const Grid g = loadGrid();
  const Support support = makeSupport(g.cell_m);
  const vec3 x_i = texelFetch(sorted_position, int(i)).xyz;
  const ivec3 cell = cellOf(g, x_i);

  float sum = 0.0;
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dx = -1; dx <= 1; ++dx) {
      const CandidateRange range = candidateRange(g, cell, dx, dz);
      const vec3 x = x_i + range.shift_m;
      for (int j = range.first; j < range.last; ++j) {
        const vec3 r = x - texelFetch(sorted_position, j).xyz;
        sum += densityShape(dot(r, r), support);
      }
    }
  }

  const float rho = sim.mass_kg * sim.density_norm * sum + floorDensity(x_i);
  const float pressure = max(sim.stiffness_m2ps2 * (rho - sim.rest_density_kgpm3), 0.0);
  pressure_point[i] = vec4(x_i, pressure / (rho * rho));
  motion_point[i] = vec4(texelFetch(sorted_velocity, int(i)).xyz, sim.mass_kg / rho);
  acceleration[i] = vec4(0.0, 0.0, 0.0, rho);
}
