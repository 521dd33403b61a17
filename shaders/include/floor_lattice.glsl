// Virtual particles of the floor: a LATTICE x LATTICE grid at spacing s, centred under the particle and snapped to the
// floor, seen by particles closer to it than H (thesis, algorithm 10). Their mass is calibrated in derive() so that a
// particle of the resting lattice's lowest layer has rest density.
#ifndef SPINDRIFT_FLOOR_LATTICE
#define SPINDRIFT_FLOOR_LATTICE

#include "include/floor.glsl"
#include "include/kernels.glsl"

#define LATTICE_POINTS (LATTICE * LATTICE)

/// From virtual particle k to the particle. [m]
vec3 latticeOffset(Floor f, vec3 x_i, float spacing_m, int k) {
  const vec2 d = vec2(k % LATTICE - LATTICE / 2, k / LATTICE - LATTICE / 2) * spacing_m;
  return vec3(-d.x, x_i.y - floorHeight(f, x_i.xz + d), -d.y);
}

/// How many lattice points a particle sees: all or none. A loop bound instead of a branch: llvmpipe runs both sides of a
/// branch, but leaves a loop that no lane needs.
int latticePoints(Floor f, vec3 x_i, float H) {
  return x_i.y - floorHeight(f, x_i.xz) < H ? LATTICE_POINTS : 0;
}

/// The floor's share of the density at x_i. [kg/m^3]
float floorDensity(vec3 x_i) {
  const Floor f = loadFloor();
  const float H = sim.support_radius_m;
  const float spacing_m = sim.spacing_m;
  const int points = latticePoints(f, x_i, H);
  float sum = 0.0;
  for (int k = 0; k < points; ++k) sum += cubicShape(length(latticeOffset(f, x_i, spacing_m, k)) / H);
  return sim.virtual_mass_kg * sim.cubic_norm * sum;
}

/// The floor's share of the acceleration: pressure (the floor answers with the particle's own pressure, momentum form) and
/// viscosity against the velocity of the moving surface. `pressure_term` = p_i / rho_i^2 [m^5/(kg s^2)].
vec3 floorAcceleration(vec3 x_i, vec3 v_i, float pressure_term, float rho_i) {
  const Floor f = loadFloor();
  const float H = sim.support_radius_m;
  const float spacing_m = sim.spacing_m;
  const int points = latticePoints(f, x_i, H);
  vec3 push = vec3(0.0);
  float drag = 0.0;
  for (int k = 0; k < points; ++k) {
    const vec3 r = latticeOffset(f, x_i, spacing_m, k);
    const float distance_m = max(length(r), 1e-4 * H);
    push += cubicSlope(distance_m / H) / (H * distance_m) * r;
    drag += viscosityLaplacian(distance_m, H);
  }
  vec3 normal;
  vec3 floor_velocity_mps;
  floorState(f, x_i.xz, normal, floor_velocity_mps);
  const float rho_0 = sim.rest_density_kgpm3;
  const float mirrored = pressure_term * (1.0 + rho_i * rho_i / (rho_0 * rho_0));
  return sim.virtual_mass_kg * (sim.cubic_norm * mirrored * push +
                                sim.viscosity_pas * sim.spiky_norm * drag / (rho_i * rho_0) * (floor_velocity_mps - v_i));
}

#endif
