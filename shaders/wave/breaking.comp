// Computes where and how strongly the wave breaks.
// Reads SURFACE (eta, d eta/dt), BASIN, BED, EventUniforms, BREAKING_BEFORE (age [s], intensity, velocity of a splash's
// crown [m/s]). Writes BREAKING, which is 0 before, where the wave may break; in two-way scenes lists the POOL_WANTED cells that emit a particle in EMITTER.
// Equation: Kennedy et al. 2000, eqs. 5-7: breaking starts where d eta/dt > 0.65 sqrt(g d); the threshold relaxes to
// 0.15 sqrt(g d) within 5 sqrt(d/g) of the event; the intensity rises from 0 to 1 between one and two thresholds. The event travels
// with the crest: a cell inherits the age of the oldest cell that broke where the crest may have come from.
#include "shared/groups.h"
#include "wave/wave_faces.glsl"
#include "coupling/emission.glsl"
#include "wave/surface_rate.glsl"
#if NONLINEAR
#include "wave/water_column.glsl"
#endif
#if POOL_PARTICLES
#include "coupling/spray_source.glsl"
#endif
#include "shared/event_uniforms.h"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = BREAKING_BEFORE) uniform samplerBuffer breaking_before;
layout(std430, binding = BREAKING) restrict writeonly buffer Breaking { vec4 breaking[]; };
#if POOL_PARTICLES
layout(std430, binding = POOL) restrict buffer Pool { uint pool[]; };
layout(std430, binding = EMITTER) restrict writeonly buffer Emitter { uint emitter[]; };
uniform uint tick;
#endif

#define LONGEST_EVENT 2.0
/// Radii of its splash beyond which there is no crown; it ends at 1.1 + 0.3.
#define CROWN_REACH 1.41

/// Horizontal velocity of the crown of splashes: outward, from a ring around the radius.
vec2 crownAt(vec2 p) {
  vec2 crown_mps = vec2(0.0);
  for (uint k = 0u; k < press_begin; ++k) {  // strokes have no crown
    const EventUniform e = splashes[k];
    const vec2 r_m = acrossSides(p - vec2(e.x_m, e.z_m));
    const float distance_m = length(r_m);
    const float ring = (distance_m / e.radius_m - 1.1) / 0.3;
    crown_mps += e.speed_mps * max(1.0 - ring * ring, 0.0) / max(distance_m, 1e-3) * r_m;
  }
  return crown_mps;
}

float ageAt(int x, int row) { return texelFetch(breaking_before, x + row).x; }

/// Returns whether the crown of a splash may reach a column of cells.
bool isBelowCrown(float x_m) {
  bool reaches = false;
  for (uint k = 0u; k < press_begin; ++k)
    reaches = reaches || (splashes[k].speed_mps > 0.0 && abs(acrossSides(vec2(x_m - splashes[k].x_m, 0.0)).x) < CROWN_REACH * splashes[k].radius_m);
  return reaches;
}

/// Height of the water at a cell. [m]
float waterAt(ivec2 cell, ivec2 n) {
  const int i = cell.x + n.x * cell.y;
#if NONLINEAR
  return texelFetch(surface_texels, i).x + stillDepth(i);
#elif VARIED
  const Flow open = conductanceOf(cell, n);
  return max(open.x, open.y) / FLOW_WEIGHTS.x;
#else
  return sim.wave_depth_m;
#endif
}

float longWaveSpeed(float depth_m) { return sqrt(sim.gravity_mps2 * max(depth_m, 0.0)); }

/// There is no breaking below the lowest threshold, on dry ground, or without gravity.
bool mayBreak(float rate_mps, float speed_mps, float depth_m) {
  return speed_mps > 0.0 && rate_mps > 0.15 * speed_mps && depth_m > 0.02 * sim.wave_depth_m;
}

void breakAt(ivec2 cell, ivec2 n) {
  const int row = n.x * cell.y;
  const int i = cell.x + row;
  const float rate_mps = smoothRate(cell, n);
  const float depth_m = waterAt(cell, n);
  const float speed_mps = longWaveSpeed(depth_m);
  vec4 state = vec4(0.0);
  if (mayBreak(rate_mps, speed_mps, depth_m)) {
    // Distance that a crest travels in a tick.
    const ivec2 hop = min(ivec2(max(int(ceil(speed_mps * sim.tick_s / sim.wave_cell_m - 0.2)), 1)), n);
    const float age_s = max(max(ageAt(cell.x, row), max(ageAt(waveNeighbourX(cell.x - hop.x, n.x), row), ageAt(waveNeighbourX(cell.x + hop.x, n.x), row))),
                            max(ageAt(cell.x, n.x * waveNeighbourZ(cell.y - hop.y, n.y)), ageAt(cell.x, n.x * waveNeighbourZ(cell.y + hop.y, n.y))));
    const float relaxed = age_s * sqrt(sim.gravity_mps2 / depth_m) / 5.0;
    // An event ends after LONGEST_EVENT relaxation times: its front has passed by then, and only small waves are left.
    const float share = age_s > 0.0 && relaxed < LONGEST_EVENT ? min(relaxed, 1.0) : 0.0;
    const float threshold_mps = mix(0.65, 0.15, share) * speed_mps;
    if (rate_mps > threshold_mps) state.xy = vec2(age_s + sim.tick_s, clamp(rate_mps / threshold_mps - 1.0, 0.0, 1.0));
  }
  state.zw = depth_m > 0.02 * sim.wave_depth_m ? crownAt(waveCellCentre(cell)) : vec2(0.0);
  const float crown_mps = length(state.zw);
  state.y = max(state.y, clamp(crown_mps / max(speed_mps, 1e-3), 0.0, 1.0));
  breaking[i] = state;
#if POOL_PARTICLES
  if (emits(cell, n.x, tick, state.y, max(rate_mps, crown_mps)) && canEmit(cell, n)) {
    const uint slot = atomicAdd(pool[POOL_WANTED], 1u);
    if (slot < sim.pool_capacity_count) emitter[slot] = uint(i);
  }
#endif
}

void main() {
  const ivec2 n = waveCounts();
  const int x = int(gl_GlobalInvocationID.x);
  const int first_z = WAVE_STRIP * int(gl_GlobalInvocationID.y);
  if (x >= n.x || first_z >= n.y) return;
  const int end_z = min(first_z + WAVE_STRIP, n.y);
  const bool below_crown = isBelowCrown(waveCellCentre(ivec2(x, 0)).x);
  const ivec2 apart = rateApart(n);
  uint rows = 0u;
  for (int begin_z = first_z; begin_z < first_z + apart.y; ++begin_z) {
    float before = rowRate(x, begin_z - apart.y, apart.x, n);
    float own = rowRate(x, begin_z, apart.x, n);
    for (int z = begin_z; z < end_z; z += apart.y) {
      const float after = rowRate(x, z + apart.y, apart.x, n);
      const float depth_m = waterAt(ivec2(x, z), n);
      if (below_crown || mayBreak(smoothRate(before, own, after), longWaveSpeed(depth_m), depth_m)) rows |= 1u << uint(z - first_z);
      before = own;
      own = after;
    }
  }
  for (; rows != 0u; rows &= rows - 1u) breakAt(ivec2(x, first_z + findLSB(rows)), n);
}
