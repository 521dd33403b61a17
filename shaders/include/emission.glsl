// Which breaking cells turn water into a particle in a tick.
#ifndef SPINDRIFT_EMISSION
#define SPINDRIFT_EMISSION

#include "include/hash.glsl"
#include "include/transfer.glsl"
#include "shared/sim_uniforms.h"

#if POOL_PARTICLES
#include "shared/pool.h"

/// Share of the rising water that a fully breaking cell throws out as spray.
#define SPRAY_SHARE 0.15

/// Expected particles in the tick: the volume thrown out over a particle's; drawn by the hash of cell and tick.
bool emits(uint cell, uint tick, float intensity, float rate_mps) {
  if (intensity <= 0.0) return false;
  const float thrown_m = sim.emission_ratio * SPRAY_SHARE * intensity * rate_mps * sim.tick_s;
  const float expected = thrown_m * ELEVATION_UNITS_PER_M / float(sim.droplet_units);
  return random3(uvec3(cell, tick, sim.seed)).x < expected;
}
#endif

#endif
