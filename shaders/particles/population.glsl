// Number of particles: from the scene, or in two-way scenes (POOL) from the device.
#ifndef SPINDRIFT_POPULATION
#define SPINDRIFT_POPULATION

#include "shared/sim_uniforms.h"

#if POOL_PARTICLES
#include "shared/pool.h"
layout(binding = POOL) uniform usamplerBuffer pool;
/// Before the sort: includes dead particles.
uint unsortedCount() { return texelFetch(pool, POOL_COUNT).x; }
/// After the sort.
uint particleCount() { return texelFetch(pool, POOL_LIVE).x; }
#else
uint unsortedCount() { return sim.particle_count; }
uint particleCount() { return sim.particle_count; }
#endif

#endif
