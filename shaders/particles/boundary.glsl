// Replaces the neighbours that are missing beyond floor and walls. The floor has its virtual lattice
// (particles/floor_support.glsl). A wall contributes a share of the rest density that depends only on the distance d:
// f(d) = C max(1 - d/D, 0)^2, with C and D from derive(). A particle half a spacing from the wall gets exactly the
// density of the missing layers. The gradient is twice theirs, because the wall pushes only with the particle's own
// pressure, while a missing neighbour would have added its own. So the column at a wall rests where the lattice rests,
// at the pressure of its depth. Shares of several boundaries combine as 1 - (1 - f_x)(1 - f_z)(1 - f_floor), so that
// corners are not counted twice. Without walls none of this is compiled.
#ifndef SPINDRIFT_BOUNDARY
#define SPINDRIFT_BOUNDARY

#include "particles/floor_support.glsl"

#define HAS_WALLS (PERIODIC_X == 0 || PERIODIC_Z == 0)

/// One pair of walls: the share f at x, and df/dx [1/m].
vec2 wallPair(float x, float low, float high) {
  const float inverse_reach_pm = 1.0 / sim.wall_reach_m;
  const float a = max(1.0 - max(x - low, 0.0) * inverse_reach_pm, 0.0);
  const float b = max(1.0 - max(high - x, 0.0) * inverse_reach_pm, 0.0);
  return sim.wall_share * vec2(a * a + b * b, 2.0 * inverse_reach_pm * (b - a));
}

/// (f_x, df_x/dx, f_z, df_z/dz)
vec4 wallShares(vec3 x_i) {
  vec4 w = vec4(0.0);
#if PERIODIC_X == 0
  w.xy = wallPair(x_i.x, sim.min_x_m, sim.max_x_m);
#endif
#if PERIODIC_Z == 0
  w.zw = wallPair(x_i.z, sim.min_z_m, sim.max_z_m);
#endif
  return w;
}

/// Density at x_i from floor and walls. [kg/m^3]
float boundaryDensity(vec3 x_i) {
  const float floor_density = floorDensity(x_i);
#if HAS_WALLS
  const vec4 w = wallShares(x_i);
  const float open = (1.0 - w.x) * (1.0 - w.z);
  return floor_density * open + sim.rest_density_kgpm3 * (1.0 - open);
#else
  return floor_density;
#endif
}

/// Acceleration from floor and walls: -(p_i / rho_i^2) grad of boundaryDensity, and the floor's viscosity.
vec3 boundaryAcceleration(vec3 x_i, vec3 v_i, float pressure_term, float rho_i) {
  const float own = max(pressure_term, 0.0);  // neither floor nor walls pull, with cohesion either
#if HAS_WALLS
  const vec4 w = wallShares(x_i);
  const float covered = sim.rest_density_kgpm3 - floorDensity(x_i);
  vec3 a = floorAcceleration(x_i, v_i, own * (1.0 - w.x) * (1.0 - w.z), rho_i);
  a.x -= own * covered * w.y * (1.0 - w.z);
  a.z -= own * covered * w.w * (1.0 - w.x);
  return a;
#else
  return floorAcceleration(x_i, v_i, own, rho_i);
#endif
}

/// Gradient of boundaryDensity. [kg/m^4]
vec3 boundaryGradient(vec3 x_i) {
  vec3 gradient = floorGradient(x_i);
#if HAS_WALLS
  const vec4 w = wallShares(x_i);
  const float covered = sim.rest_density_kgpm3 - floorDensity(x_i);
  gradient *= (1.0 - w.x) * (1.0 - w.z);
  gradient.x += covered * w.y * (1.0 - w.z);
  gradient.z += covered * w.w * (1.0 - w.x);
#endif
  return gradient;
}

#endif
