// Decides which breaking cells turn water into a particle in a tick.
#ifndef SPINDRIFT_EMISSION
#define SPINDRIFT_EMISSION

#include "common/hash.glsl"
#include "wave/transfer.glsl"
#include "shared/sim_uniforms.h"

#if POOL_PARTICLES
#include "shared/pool.h"

/// Share of the rising water that a fully breaking cell emits as spray.
#define SPRAY_SHARE 0.15

/// Expected particles per tick: the emitted volume over a particle's volume; drawn by the hash of cell and tick. If
/// only one cell of a block may emit, that cell is drawn first and emits for the whole block.
bool emits(ivec2 at, int n, uint tick, float intensity, float rate_mps) {
  if (intensity <= 0.0) return false;
  const uint cell = uint(at.x + n * at.y);
  const uint block = sim.spray_block_count;
  const uvec2 inside = uvec2(at) % block;
  const uvec2 corner = uvec2(at) - inside;
  if (block > 1u && hashed(uvec3(corner.x + uint(n) * corner.y, tick, sim.seed ^ 0xc2b2ae35u)).x % (block * block) != inside.x + block * inside.y) return false;
  const float thrown_m = sim.emission_ratio * SPRAY_SHARE * intensity * rate_mps * sim.tick_s;
  const float expected = thrown_m * ELEVATION_UNITS_PER_M / float(sim.droplet_units);
  return random3(uvec3(cell, tick, sim.seed)).x < expected * float(block * block);
}
#endif

#endif
