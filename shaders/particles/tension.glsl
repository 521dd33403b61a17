// Surface tension between pairs of particles, with coefficients in SI units from sim_setup/surface_tension.h. Two parts:
//   area   E = kappa/2 sum_i V |grad c_i|^2, c = sum_j V W_ij: an energy of the surface alone, 0 inside the water; its force is
//          -kappa V^2 (grad grad W)(grad c_i - grad c_j)
//   pull   a weak attraction A q (1 - q)^2 along the line of the pair, which keeps the particles of the surface: the area alone would
//          be less if they left
// The attraction alone makes a drop that has come to rest a solid: it takes ten times the drop's own pressure, and particles under
// pressure lock (docs/decisions/133-surface-tension.md). W is the kernel of Wendland (1995), whatever the kernel set.
// Invariants: antisymmetric in the pair, so that momentum stays; bounded, 0 at r = 0 and r >= H.
#ifndef SPINDRIFT_TENSION
#define SPINDRIFT_TENSION

#include "particles/kernels.glsl"
#include "shared/sim_uniforms.h"

#if TENSION
/// What a neighbour adds to SURFACE_GRADIENT [m]: -grad W over its norm. `r` from the neighbour, r2 = |r|^2.
vec3 surfaceShare(vec3 r, float r2, Support k) {
  const float u = max(1.0 - sqrt(r2) * k.inverse_H, 0.0);
  return (u * u * u) * r;
}

/// Acceleration by a neighbour. [m/s^2] `s`: SURFACE_GRADIENT of the particle less that of the neighbour.
vec3 tension(vec3 r, float r2, vec3 s, Support k) {
  const float distance_m = sqrt(r2);
  const float u = max(1.0 - distance_m * k.inverse_H, 0.0);
  const vec3 area = u * s - (3.0 * k.inverse_H / max(distance_m, 1e-9) * dot(r, s)) * r;
  return -(u * u) * (sim.tension_area_ps2 * area + sim.tension_pull_ps2 * r);
}
#endif

#endif
