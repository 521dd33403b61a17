// Particles that fall back onto the surface: their volume is added to the elevation, their momentum downward to the pressure
// head, that along the surface to the flow, where the bulk is nonlinear (coupling/mix.comp).
#ifndef SPINDRIFT_ABSORPTION
#define SPINDRIFT_ABSORPTION

#if NONLINEAR
#include "coupling/landed_water.glsl"
#endif
#include "coupling/splat.glsl"
#include "foam/foam_cell.glsl"
#include "wave/transfer.glsl"
#include "shared/pool.h"

layout(std430, binding = ELEVATION) restrict buffer Elevation { int elevation[]; };
layout(std430, binding = PRESSURE_HEAD) restrict buffer PressureHead { int pressure_head[]; };
layout(std430, binding = POOL) restrict buffer PoolWords { uint pool_words[]; };
#if SURFACE_FOAM
layout(std430, binding = LANDED) restrict buffer Landed { uint landed[]; };
#endif

void addWater(int i, int units, vec2 v_mps) {
  atomicAdd(elevation[i], units);
#if NONLINEAR
  const ivec2 momentum = ivec2(round(v_mps * (float(units) * ELEVATION_UNIT_M * MOMENTUM_UNITS)));
  atomicAdd(landed_water[LANDED_WORDS * i], units);
  atomicAdd(landed_water[LANDED_WORDS * i + 1], momentum.x);
  atomicAdd(landed_water[LANDED_WORDS * i + 2], momentum.y);
#endif
}

/// Absorbs a particle at xz with the velocity `v_mps`. During the next tick its momentum downward acts on the surface as
/// the height of water V v / (g dt) over the cell's area, which makes the ring of a falling drop. An impulse as narrow
/// as the splat moves water only to about that depth, while the shallow-water flow moves the whole column, so the
/// impulse is reduced in that ratio.
/// Invariant: ELEVATION gains exactly droplet_units.
void absorb(vec2 xz, vec3 v_mps) {
  const ivec2 n = waveCounts();
  const ivec2 middle = wetCellAt(xz, n);
  const int i = middle.x + n.x * middle.y;
  const int amount = int(sim.droplet_units);
  const float reached = min(2.0 * sim.splat_width_m / sim.wave_depth_m, 1.0);
  const float head = reached * float(amount) * max(-v_mps.y, 0.0) / max(sim.gravity_mps2 * sim.tick_s, 1e-6);
  const int head_units = int(min(head, 0.5 * TRANSFER_MAX_UNITS));
  int rest = amount;
  const int reach = int(sim.splat_reach_count);
  for (int dz = -2 * reach; dz <= 2 * reach; ++dz) {
    for (int dx = -2 * reach; dx <= 2 * reach; ++dx) {
      const int at = splatTarget(middle, ivec2(dx, dz), n);
      if (at < 0) continue;
      const int share = splatShare(amount, ivec2(dx, dz), reach);
      addWater(at, share, v_mps.xz);
      atomicAdd(pressure_head[at], splatShare(head_units, ivec2(dx, dz), reach));
      rest -= share;
    }
  }
  if (rest != 0) addWater(i, rest, v_mps.xz);
  atomicAdd(pool_words[POOL_ABSORBED], 1u);
#if SURFACE_FOAM
  atomicAdd(landed[foamIndexOf(foamCellOf(middle, n), n)], 1u);
#endif
}

#endif
