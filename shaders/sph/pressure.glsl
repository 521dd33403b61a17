// Pressure from density: the equation of state, chosen when a shader is specialised.
//   TAIT = 0   p = k (rho - rho_0)                                             thesis 3.9
//   TAIT = 1   p = k rho_0 / 7 ((rho / rho_0)^7 - 1), k = c0^2                  Monaghan 1994
//   COHESION = 0 keeps p >= 0: water does not pull. COHESION = 1 allows p < 0.
#ifndef SPINDRIFT_PRESSURE
#define SPINDRIFT_PRESSURE

#include "shared/sim_uniforms.h"

float pressureOf(float rho) {
  float p = sim.stiffness_m2ps2 * (rho - sim.rest_density_kgpm3);
#if TAIT
  // x^7 - 1 = (x - 1)(1 + x + ... + x^6): no cancellation near the rest density.
  const float x = rho / sim.rest_density_kgpm3;
  p *= (1.0 + x * (1.0 + x * (1.0 + x * (1.0 + x * (1.0 + x * (1.0 + x)))))) * (1.0 / 7.0);
#endif
#if COHESION
  return p;
#else
  return max(p, 0.0);
#endif
}

#endif
