// Particles that approach each other collide inelastically: the quadratic artificial viscosity of von Neumann and
// Richtmyer (1950) between pairs (Monaghan & Gingold 1983). A pair that approaches with the speed u along its line feels
// the additional pressure rho_0 q with q = k u^2. It stops what viscosity of water is too weak to stop at this spacing:
// sheets and drops that meet at a wall, and the sound that they make. In smooth flow u falls with the spacing, and q with
// its square. Without it weakly compressible water comes apart behind the first wall that it meets.
#ifndef SPINDRIFT_COLLISION
#define SPINDRIFT_COLLISION

#include "shared/sim_uniforms.h"

/// k. 3 is too weak for weakly compressible water behind a wall; from 8 on the column of a dam stays up
/// (docs/decisions/115-collisions-of-particles.md).
const float COLLISION_FACTOR = 6.0;

/// Largest k u [m/s]: a quarter of a spacing per step, so that a step does not reverse an approach.
float collisionLimit() { return 0.25 * sim.spacing_m / sim.dt_s; }

/// q of a pair [m^2/s^2]. `r` and `v`: position and velocity of one relative to the other; r2 = |r|^2; `limit_mps` from
/// collisionLimit().
float collision(vec3 r, float r2, vec3 v, float limit_mps) {
  const float approach_mps = max(-dot(v, r), 0.0) * inversesqrt(max(r2, 1e-12));
  return approach_mps * min(COLLISION_FACTOR * approach_mps, limit_mps);
}

#endif
