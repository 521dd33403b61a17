// White water on the surface, once per tick: carried by the water, fading at a rate per source, produced by breakers,
// wakes and landings.
// Reads FOAM_BEFORE [foamCounts(): breaking, wake, landing, 0], SURFACE_FLOW, BREAKING, BOATS, LANDED. Writes FOAM_FIELD; clears LANDED.
// Equation: semi-Lagrangian transport, f(x, t + dt) = f(x - u dt, t) exp(-dt/lifetime) + source; each share of white is at most 1.
#include "shared/groups.h"
#include "foam/foam_cell.glsl"
#include "wave/wave_cell.glsl"
#if HULLS
#include "bodies/boat.glsl"
layout(binding = BOATS) uniform samplerBuffer boats;
#endif

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = FOAM_BEFORE) uniform samplerBuffer foam_before;
layout(binding = SURFACE_FLOW) uniform samplerBuffer flow_texels;
layout(binding = BREAKING) uniform samplerBuffer breaking;
layout(std430, binding = FOAM_FIELD) restrict writeonly buffer FoamField { vec4 foam[]; };
#if LANDINGS
layout(std430, binding = LANDED) restrict buffer Landed { uint landed[]; };
#endif

/// Foam from one second of full breaking, and from one particle that falls back.
const float kBreakingGain_per_s = 3.0;
const float kLandingGain = 0.06;
const float kWakeGain_per_s = 5.0;

vec4 before(ivec2 cell, ivec2 n) {
  return texelFetch(foam_before, waveNeighbourX(cell.x, n.x) + n.x * waveNeighbourZ(cell.y, n.y));
}

#if HULLS
/// Foam at the stern and the sides of boats, by their speed.
float wakeAt(vec2 p) {
  float wake = 0.0;
  for (int place = 0; place < int(boat_place_count); ++place) {
    const vec4 pose = texelFetch(boats, place * BOAT_TEXELS);
    const float age_s = texelFetch(boats, place * BOAT_TEXELS + 1).z;
    const float speed_mps = texelFetch(boats, place * BOAT_TEXELS + 2).x;
    const vec4 hull_m = texelFetch(boats, place * BOAT_TEXELS + 4);
    const float full_mps = texelFetch(boats, place * BOAT_TEXELS + 5).x;
    const vec2 d = acrossSides(p - pose.xz);
    const float a = dot(d, forwardOf(pose.w)) / hull_m.x;
    const float b = dot(d, starboardOf(pose.w)) / hull_m.y;
    const float stern = exp(-40.0 * (a + 0.55) * (a + 0.55) - 4.0 * b * b);
    const float bow = 0.6 * exp(-60.0 * (a - 0.42) * (a - 0.42) - 5.0 * (abs(b) - 0.45) * (abs(b) - 0.45));
    wake += age_s >= 0.0 ? (stern + bow) * clamp(abs(speed_mps) / full_mps, 0.0, 1.2) : 0.0;
  }
  return wake;
}
#endif

void main() {
  const ivec2 wave_n = waveCounts();
  const ivec2 n = foamCounts(wave_n);
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, n))) return;
  const ivec2 wave_cell = firstWaveCellOf(cell, wave_n);
  const int wave_row = wave_cell.x + wave_n.x * wave_cell.y;
  const vec2 cell_m = vec2(wave_n) / vec2(n) * sim.wave_cell_m;

  const vec2 flow_mps = texelFetch(flow_texels, wave_row).xy;
  const vec2 most = vec2(min(ivec2(2), n - 1));  // no further than narrow water has cells
  const vec2 from = vec2(cell) - clamp(flow_mps * sim.tick_s / cell_m, -most, most);
  const vec2 c = floor(from);
  const vec2 t = from - c;
  const ivec2 k = ivec2(c);
  vec4 f = mix(mix(before(k, n), before(k + ivec2(1, 0), n), t.x),
               mix(before(k + ivec2(0, 1), n), before(k + ivec2(1, 1), n), t.x), t.y);
  f *= vec4(sim.breaking_foam_keep_ratio, sim.wake_foam_keep_ratio, sim.landing_foam_keep_ratio, 0.0);

  const int right = wave_cell.x + 1 < wave_n.x ? 1 : 0;
  const int below = wave_cell.y + 1 < wave_n.y ? wave_n.x : 0;
  const float intensity = max(max(texelFetch(breaking, wave_row).y, texelFetch(breaking, wave_row + right).y),
                              max(texelFetch(breaking, wave_row + below).y, texelFetch(breaking, wave_row + below + right).y));
  f.x += kBreakingGain_per_s * sim.tick_s * intensity;
#if HULLS
  const vec2 p = (vec2(cell) + 0.5) * cell_m - waveHalf_m();
  f.y += kWakeGain_per_s * sim.tick_s * wakeAt(p);
#endif
#if LANDINGS
  f.z += kLandingGain * float(landed[cell.x + n.x * cell.y]);
  landed[cell.x + n.x * cell.y] = 0u;
#endif
  foam[cell.x + n.x * cell.y] = min(f, vec4(1.0));
}
