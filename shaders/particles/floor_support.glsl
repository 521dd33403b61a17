// The support of the floor. A flat floor (!COUPLED) supports like a wall (particles/boundary.glsl): f(d) = C max(1 -
// d/D, 0)^2 of the rest density, whose slope carries the lowest layer at the pressure of its depth.
// Under coupled water the floor consists of virtual particles: a LATTICE x LATTICE grid with spacing s, centred under
// the particle and half a spacing below the floor, where the next layer of the water would be. It acts on particles
// closer than H (thesis, algorithm 10, cubic kernel). derive() calibrates the mass so that a particle of the resting
// lattice's lowest layer has rest density. With the grid on the floor itself, as in the thesis, its density hardly
// changed with the distance, and the lowest layer fell through. In both forms the force is the gradient of the density,
// so that a floor at rest neither adds nor removes energy.
#ifndef SPINDRIFT_FLOOR_SUPPORT
#define SPINDRIFT_FLOOR_SUPPORT

#include "particles/floor.glsl"
#include "particles/kernels.glsl"

#if POOL_PARTICLES || PERIODIC_Y
// In two-way scenes the surface absorbs particles instead of carrying them; a box that is periodic in y has no floor.
float floorDensity(vec3 x_i) { return 0.0; }
vec3 floorGradient(vec3 x_i) { return vec3(0.0); }
vec3 floorAcceleration(vec3 x_i, vec3 v_i, float pressure_term, float rho_i) { return vec3(0.0); }
#elif !COUPLED
/// Remaining reach above a flat floor, 1 at the floor, 0 beyond its reach.
float flatFloorReach(vec3 x_i) { return max(1.0 - max(x_i.y + sim.band_m, 0.0) / sim.wall_reach_m, 0.0); }

/// Density at x_i from the floor. [kg/m^3]
float floorDensity(vec3 x_i) {
  const float u = flatFloorReach(x_i);
  return sim.rest_density_kgpm3 * sim.wall_share * u * u;
}

/// Gradient of floorDensity. [kg/m^4]
vec3 floorGradient(vec3 x_i) { return vec3(0.0, -2.0 * sim.rest_density_kgpm3 * sim.wall_share * flatFloorReach(x_i) / sim.wall_reach_m, 0.0); }

/// Acceleration by the floor: pressure, -(p_i / rho_i^2) times the gradient, and viscosity against the floor at rest, which
/// is implicit in the step: below the lowest layer's position it is stiffer than between particles.
/// `pressure_term` = p_i / rho_i^2 [m^5/(kg s^2)].
vec3 floorAcceleration(vec3 x_i, vec3 v_i, float pressure_term, float rho_i) {
  const float u = flatFloorReach(x_i);
  const float rate_ps = sim.viscosity_pas / rho_i * sim.floor_drag_pm2 * u * u;
  return -pressure_term * floorGradient(x_i) - rate_ps / (1.0 + sim.dt_s * rate_ps) * v_i;
}
#else
#define LATTICE_REACH (LATTICE / 2)

/// Vector from the virtual particle at (ix, iz) spacings to the particle. [m]
vec3 latticeOffset(Floor f, vec3 x_i, float spacing_m, int ix, int iz) {
  const vec2 d = vec2(ix, iz) * spacing_m;
  return vec3(-d.x, x_i.y - floorHeight(f, x_i.xz + d) + 0.5 * spacing_m, -d.y);
}

/// Last row of the lattice in reach of a particle, from -LATTICE_REACH: all rows or none. A loop bound instead of a
/// branch, because llvmpipe executes both sides of a branch but leaves a loop that no lane needs.
int lastLatticeRow(Floor f, vec3 x_i, float H, float spacing_m) {
  return x_i.y - floorHeight(f, x_i.xz) + 0.5 * spacing_m < H ? LATTICE_REACH : -LATTICE_REACH - 1;
}

/// Density at x_i from the floor. [kg/m^3]
float floorDensity(vec3 x_i) {
  const Floor f = loadFloor();
  const float H = sim.support_radius_m;
  const float spacing_m = sim.spacing_m;
  const int last_row = lastLatticeRow(f, x_i, H, spacing_m);
  const float inverse_H = 1.0 / H;
  float sum = 0.0;
  for (int iz = -LATTICE_REACH; iz <= last_row; ++iz) {
    for (int ix = -LATTICE_REACH; ix <= LATTICE_REACH; ++ix) sum += cubicShape(length(latticeOffset(f, x_i, spacing_m, ix, iz)) * inverse_H);
  }
  return sim.virtual_mass_kg * sim.cubic_norm * sum;
}

/// Sums over the virtual particles: xyz is the cubic kernel's slope toward the particle, w the viscosity's Laplacian,
/// without norms.
vec4 latticeSums(vec3 x_i) {
  const Floor f = loadFloor();
  const float H = sim.support_radius_m;
  const float spacing_m = sim.spacing_m;
  const int last_row = lastLatticeRow(f, x_i, H, spacing_m);
  const float inverse_H = 1.0 / H;
  vec3 push = vec3(0.0);
  float drag = 0.0;
  for (int iz = -LATTICE_REACH; iz <= last_row; ++iz) {
    for (int ix = -LATTICE_REACH; ix <= LATTICE_REACH; ++ix) {
      const vec3 r = latticeOffset(f, x_i, spacing_m, ix, iz);
      const float distance_m = max(length(r), 1e-4 * H);
      push += cubicSlope(distance_m * inverse_H) / distance_m * r;
      drag += viscosityLaplacian(distance_m, H);
    }
  }
  return vec4(push, drag);
}

/// Gradient of floorDensity. [kg/m^4]
vec3 floorGradient(vec3 x_i) { return -sim.virtual_mass_kg * sim.cubic_norm / sim.support_radius_m * latticeSums(x_i).xyz; }

/// Acceleration by the floor: pressure, -(p_i / rho_i^2) grad of floorDensity (Akinci et al. 2012, eq. 9), and
/// viscosity against the velocity of the moving surface. `pressure_term` = p_i / rho_i^2 [m^5/(kg s^2)].
vec3 floorAcceleration(vec3 x_i, vec3 v_i, float pressure_term, float rho_i) {
  const vec4 sums = latticeSums(x_i);
  vec3 normal;
  vec3 floor_velocity_mps;
  floorState(loadFloor(), x_i.xz, normal, floor_velocity_mps);
  return sim.virtual_mass_kg * (sim.cubic_norm / sim.support_radius_m * pressure_term * sums.xyz +
                                sim.viscosity_norm * sim.viscosity_pas * sums.w / (rho_i * sim.rest_density_kgpm3) * (floor_velocity_mps - v_i));
}
#endif

#endif
